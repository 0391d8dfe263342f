package skein.forward

import scala.util.boundary
import scala.util.boundary.break
import skein.policy.*
import skein.signal.SplitMix64

/** The homicidal chauffeur with ideal kinematics, on both sides of its threshold: R = 8 m, speeds 10 and 5
  * m/s.
  */
class HomicidalChauffeurSimulation extends munit.FunSuite:
  private val game      = HomicidalChauffeur(turningRadiusM = 8, speedRatio = 0.5)
  private val dodgeM    = game.speedRatio * game.turningRadiusM
  private val turnRate  = 10 / game.turningRadiusM
  private val threshold = game.thresholdM
  private val pure      = PurePursuit(turnRate)

  /** Initial position and course of the evader, in the frame of a pursuer that flies north. */
  private final case class Start(ahead: Double, right: Double, headingRad: Double):
    val distance: Double          = math.hypot(ahead, right)
    override def toString: String = f"start $ahead%.3f m ahead, $right%.3f m right, at $headingRad%.3f rad"

  private def starts(seed: Long, count: Int): Vector[Start] =
    val random = SplitMix64(seed)
    Vector.fill(count):
      val distance = 1.2 * math.pow(40, random.nextDouble())
      val bearing  = 2 * math.Pi * random.nextDouble()
      Start(
        distance * math.cos(bearing),
        distance * math.sin(bearing),
        2 * math.Pi * random.nextDouble()
      )

  private val timing = LoopTiming.Paused(0.0025)

  private def duel(pursuer: Policy, evader: Policy, start: Start, durationS: Double): Engagement =
    val engaged = Pair(
      Pair.paper.pursuer.copy(policy = pursuer, startX = 0, startY = 0, startHeadingRad = 0),
      Pair.paper.evader.copy(
        policy = evader,
        startX = start.ahead,
        startY = start.right,
        startHeadingRad = start.headingRad
      ),
      durationS
    )
    engaged.engagement

  private def closestM(
      pursuer: Policy,
      evader: Policy,
      start: Start,
      durationS: Double
  ): Double =
    ScoredRollout(duel(pursuer, evader, start, durationS), timing, DelayTable.none, VelocityResponses.Ideal)
      .fly(0)
      .minDistanceM

  /** Simulates until capture, or to the end without it. */
  private def captureS(
      pursuer: Policy,
      evader: Policy,
      start: Start,
      captureM: Double,
      durationS: Double
  ): Double =
    boundary:
      Rollout(duel(pursuer, evader, start, durationS), timing, DelayTable.none, VelocityResponses.Ideal).fly(
        0,
        observer = PaperPath((timeS, ex, ey, px, py) =>
          if math.hypot(ex - px, ey - py) <= captureM then break(timeS)
        )
      )
      Double.PositiveInfinity

  /** Runs straight away; when the pursuer is γ turning radii behind, turns aside by a right angle, and keeps
    * that direction while the pursuer turns after it.
    */
  private val barrier: HeadingPolicy.Memoryless = seen =>
    import seen.{dxM as dx, dyM as dy, opponentHeadingRad as pursuer, ownHeadingRad as own}
    val ahead = -dx * math.cos(pursuer) - dy * math.sin(pursuer)
    val right = dx * math.sin(pursuer) - dy * math.cos(pursuer)
    val aside = math.abs(math.IEEEremainder(own - pursuer, 2 * math.Pi))
    if math.hypot(dx, dy) > dodgeM || ahead <= 0 then math.atan2(-dy, -dx)
    else if aside > math.toRadians(40) && aside < math.toRadians(100) then own
    else pursuer + (if right >= 0 then 1 else -1) * math.Pi / 2

  /** Crosses the barriers as steeply as it can; within the circle where it may wait, it heads for the centre.
    */
  private val steepest: HeadingPolicy.Memoryless = seen =>
    import seen.{dxM as dx, dyM as dy, opponentHeadingRad as pursuer}
    val (cos, sin)       = (math.cos(pursuer), math.sin(pursuer))
    val (ahead, right)   = (-dx * cos - dy * sin, dx * sin - dy * cos)
    val side             = if right < 0 then -1.0 else 1.0
    val h                = 1e-4
    def rise(at: Double) =
      game.radiusNeededM(ahead + h * math.cos(at), right * side + h * math.sin(at)) -
        game.radiusNeededM(ahead - h * math.cos(at), right * side - h * math.sin(at))
    val (forward, outward) = (rise(0), rise(math.Pi / 2))
    val course             =
      if (forward * outward).isNaN || (forward * outward).isInfinite then
        math.atan2(game.turningRadiusM - right * side, -ahead)
      else math.atan2(outward, forward)
    pursuer + side * course

  private val hunter: HeadingPolicy.Memoryless = seen => math.atan2(seen.dyM, seen.dxM)
  private val away: HeadingPolicy.Memoryless   = seen => math.atan2(-seen.dyM, -seen.dxM)

  private val evaders: Seq[(String, Int => Policy)] =
    val shape = NeuralShape(Vector(6))
    Seq(
      "the barrier's evader"      -> (_ => barrier),
      "the steepest evader"       -> (_ => steepest),
      "the circle's evader"       -> (_ => ChauffeurEvader(game.turningRadiusM, game.speedRatio, dodgeM)),
      "one that follows"          -> (_ => hunter),
      "one that runs away"        -> (_ => away),
      "one that keeps its course" -> (_ => KeepHeading),
      "the paper's evader"        -> (_ => PaperEvader()),
      "a network of no sense"     -> (number =>
        val random = SplitMix64(number)
        NeuralPolicy(shape, Vector.fill(shape.parameters)(6 * random.nextDouble() - 3), 6)
      )
    )

  test(
    "where the barriers touch, straight ahead, a hard turn needs the threshold's radius, and less elsewhere"
  ):
    assertEqualsDouble(threshold, 1.0226, 1e-4)
    assertEqualsDouble(game.radiusNeededM(dodgeM, 0), threshold, 1e-9)
    for tenths <- 1 to 300 if tenths != 40 do
      val needed = game.radiusNeededM(tenths * 0.1, 0)
      assert(needed < threshold, s"$needed m at ${tenths * 0.1} m")

  test(
    "no sidestep takes an evader straight ahead farther from a hard-turning pursuer than the threshold"
  ):
    val missed =
      for
        quarters <- 8 to 24
        degrees  <- 60 to 120 by 5
      yield
        val ahead = Start(quarters / 4.0, 0, math.toRadians(degrees))
        (closestM(pure, KeepHeading, ahead, 1.5), quarters / 4.0, degrees)
    val best = missed.max
    assertEqualsDouble(best._1, threshold, 0.01 * threshold)
    assertEquals((best._2, best._3), (dodgeM, 90))

  /** The evader's position in the pursuer's frame after the evader ran at an angle to the pursuer's heading
    * and the pursuer turned right.
    */
  private def after(start: Start, courseRad: Double, seconds: Double): Start =
    val turn = turnRate * seconds
    val x    = start.ahead + 5 * seconds * math.cos(courseRad) - game.turningRadiusM * math.sin(turn)
    val y    = start.right + 5 * seconds * math.sin(courseRad) - game.turningRadiusM * (1 - math.cos(turn))
    Start(
      x * math.cos(turn) + y * math.sin(turn),
      y * math.cos(turn) - x * math.sin(turn),
      start.headingRad
    )

  test("while the pursuer turns hard, an evader can keep the radius that is needed, but cannot increase it"):
    val dt = 1e-4
    for (start, number) <- starts(seed = 4, 300).zipWithIndex if start.right > 0.1 do
      val needed = game.radiusNeededM(start.ahead, start.right)
      if needed.isFinite then
        val rates = (0 until 3600).map: tenths =>
          val turned = after(start, math.toRadians(tenths * 0.1), dt)
          (game.radiusNeededM(turned.ahead, turned.right) - needed) / dt
        assertEqualsDouble(rates.max, 0, 0.05, s"seed 4, number $number, $start")

  test("at the edge of the region in which the evader can be run over, the radius needed is its distance"):
    for distance <- Seq(0.5, 1.0, 2.0) do
      val edge = game.edgeRad - 1e-9
      assertEqualsDouble(
        game.radiusNeededM(distance * math.cos(edge), distance * math.sin(edge)),
        distance,
        1e-6
      )

  private def chauffeur(captureM: Double) =
    ChauffeurPursuer(game.turningRadiusM, game.speedRatio, captureM, turnRate)

  for
    percent        <- Seq(5, 10)
    (name, evader) <- if percent == 5 then evaders else evaders.take(1)
  do
    val captureM = (1 + percent * 0.01) * threshold
    test(
      s"with a capture radius $percent % above the threshold, the chauffeur captures $name from every start"
    ):
      val count = if evader == evaders.head._2 then 300 else 40
      for (start, number) <- starts(seed = 1, count).zipWithIndex do
        val atS = captureS(chauffeur(captureM), evader(number), start, captureM, start.distance / 5 + 15)
        assert(atS.isFinite, s"seed 1, number $number, $start")

  for (name, pursuer) <- Seq(
      "the chauffeur"           -> chauffeur(0.95 * threshold),
      "pure pursuit"            -> pure,
      "lead pursuit"            -> LeadPursuit(game.speedRatio, 1, turnRate),
      "proportional navigation" -> ProportionalNavigation(3, turnRate)
    )
  do
    test(
      s"5 % below the threshold the barrier's evader escapes $name for a minute, from outside the barriers"
    ):
      val count   = if pursuer == pure then 30 else 15
      val outside = starts(seed = 2, count).filter(start => start.distance > dodgeM || start.ahead < 0)
      for (start, number) <- outside.zipWithIndex do
        val atS = captureS(pursuer, barrier, start, 0.95 * threshold, 60)
        assert(atS.isInfinite, s"seed 2, number $number, $start: captured after $atS s")

  test(
    "5 % below the threshold the evader is lost nearer straight " +
      "ahead than where the barriers meet, and no farther"
  ):
    val captureM                                      = 0.95 * threshold
    def meet(within: Double, without: Double): Double =
      val middle = (within + without) / 2
      if without - within < 1e-9 then middle
      else if game.radiusNeededM(middle, 0) < captureM then meet(middle, without)
      else meet(within, middle)
    val metres                         = meet(captureM, dodgeM)
    def capture(share: Double): Double =
      captureS(chauffeur(captureM), steepest, Start(share * metres, 1e-3, 0), captureM, 20)
    for share <- Seq(0.5, 0.8, 0.95, 0.98) do assert(capture(share) < 1, s"$share of $metres m")
    for share <- Seq(1.02, 1.05, 1.1) do assert(capture(share).isInfinite, s"$share of $metres m")

  test(
    "pure pursuit never captures an evader that waits inside its " +
      "turning circle; the chauffeur flies off and does"
  ):
    val waits    = ChauffeurEvader(game.turningRadiusM, game.speedRatio, dodgeM)
    val beside   = Start(0, game.turningRadiusM, 0)
    val captureM = 1.1 * threshold
    assert(captureS(pure, waits, beside, captureM, 60).isInfinite)
    assert(captureS(chauffeur(captureM), waits, beside, captureM, 16).isFinite)
