package skein.forward

import scala.collection.mutable.ArrayBuffer
import skein.policy.{Action, HeadingPolicy, PaperPursuer, Policy, PurePursuit}
import skein.signal.LatencyDistribution
import skein.simd.WorldRandom
import skein.units.*
import skein.vehicle.*

/** Results of the rollout that follow from geometry, game theory or numerics. */
class RolloutOracleSuite extends munit.FunSuite:
  private val away: HeadingPolicy.Memoryless = seen => math.atan2(-seen.dyM, -seen.dxM)
  private val lag                            = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0)
  private val perfect                        = LoopTiming.Predictive(predictor = lag.predictor)
  private val loops                          =
    Seq(LoopTiming.Paused(), LoopTiming.Sequential(), LoopTiming.Futures(), LoopTiming.Stream(), perfect)

  private def duel(
      pursuer: Policy,
      evader: Policy,
      startX: Double,
      startY: Double,
      durationS: Double
  ): Pair =
    Pair(
      Pair.paper.pursuer.copy(policy = pursuer),
      Pair.paper.evader.copy(policy = evader, startX = startX, startY = startY, startHeadingRad = 0),
      durationS
    )

  private def positions(duel: Pair, timing: LoopTiming, link: Delays, model: VelocityResponse, key: Int) =
    val points = ArrayBuffer.empty[Vector[Double]]
    Rollout(duel.engagement, timing, link, model).fly(
      key,
      observer = PaperPath((_, ex, ey, px, py) => points += Vector(ex, ey, px, py))
    )
    points.toVector

  private def assertClose(actual: Seq[Double], expected: Seq[Double], tolerance: Double): Unit =
    assertEquals(actual.size, expected.size)
    for (a, e) <- actual.zip(expected) do assertEqualsDouble(a, e, tolerance)

  // ---- geometry

  for radiusM <- Seq(0.5, 2.0, 8.0) do
    test(s"a straight chase to $radiusM m takes (d − l) / (vP − vE), to a period"):
      val chase = duel(PurePursuit(1), away, 21, 0, 10)
      val flown =
        ScoredRollout(chase.engagement, LoopTiming.Paused(0.002), DelayTable.none, VelocityResponses.Ideal)
          .fly(0, captureRadiusM = radiusM)
      assertEqualsDouble(flown.captureS, (21.0 - radiusM) / (10.0 - 5.0), 0.0021)

  for loop <- loops do
    test(s"${loop.productPrefix}: the mirrored duel is the mirror image"):
      // Unlike the paper's evader, this one breaks away to the side on which it is.
      val evader: HeadingPolicy.Memoryless =
        seen => 0.7 * math.atan2(-seen.dyM, -seen.dxM) + 0.3 * math.sin(seen.ownHeadingRad)
      def fly(side: Double) =
        val start = duel(PaperPursuer(), evader, 21, 2 * side, 20)
        val whole = start.copy(evader = start.evader.copy(startHeadingRad = 0.4 * side))
        positions(whole, loop, DelayTable.vpn, lag, WorldRandom.key(5, 0, 0))
      for (there, here) <- fly(1).zip(fly(-1)) do
        assertClose(here, Seq(there(0), -there(1), there(2), -there(3)), 1e-6)

    test(s"${loop.productPrefix}: nothing changes when the world is turned and moved"):
      val plain                 = Pair.paper.copy(evader = Pair.paper.evader.copy(startY = 2))
      val (cos, sin)            = (math.cos(0.7), math.sin(0.7))
      def turn(d: RolloutAgent) = d.copy(
        startX = 100 + d.startX * cos - d.startY * sin,
        startY = -50 + d.startX * sin + d.startY * cos,
        startHeadingRad = d.startHeadingRad + 0.7
      )
      val turned = plain.copy(pursuer = turn(plain.pursuer), evader = turn(plain.evader))
      val key    = WorldRandom.key(1, 2, 3)
      for (a, b) <- positions(plain, loop, DelayTable.direct, lag, key)
          .zip(positions(turned, loop, DelayTable.direct, lag, key))
      do
        val expected = Seq(
          100 + a(0) * cos - a(1) * sin,
          -50 + a(0) * sin + a(1) * cos,
          100 + a(2) * cos - a(3) * sin,
          -50 + a(2) * sin + a(3) * cos
        )
        assertClose(b, expected, 1e-6)

  // ---- timing

  private def headings(timing: LoopTiming, link: Delays): Map[Int, Vector[Double]] =
    val sent     = Map(0 -> ArrayBuffer.empty[Double], 1 -> ArrayBuffer.empty[Double])
    val observer = new LoopObserver:
      override def commanded(vehicle: Int, number: Int, atNs: Long, action: Action): Unit =
        sent(vehicle) += action.headingRad(0)
    Rollout(Pair.paper.copy(durationS = 20).engagement, timing, link, lag).fly(0, observer = observer)
    sent.view.mapValues(_.toVector).toMap

  for roundTripMs <- Seq(0.0, 30.0, 70.0) do
    test(s"over a constant $roundTripMs ms, predictive with a perfect model decides as the paused loop does"):
      val link  = DelayTable.of(LatencyDistribution.Constant(Span.ofMillis(roundTripMs)))
      val truth = headings(LoopTiming.Paused(), DelayTable.none)
      val flown = headings(perfect, link)
      for vehicle <- 0 to 1 do
        val known = flown(vehicle)
        assert(known.size > 190, known.size)
        assertClose(known, truth(vehicle).take(known.size), 1e-6)

  // ---- numerics

  test(
    "the quadrotor's integration converges with the first order of its step: rotors act two steps late"
  ):
    def fly(division: Int): (Double, Double) =
      val stepS = Quadrotor.AirSimStepS / division
      // The integral's discount is meant for 3 ms; per second it must stay the same.
      val gains     = ControllerGains(verticalDiscount = math.pow(0.9999, 1.0 / division))
      val quadrotor = Quadrotor(gains = gains, stepS = stepS)
      val state     = quadrotor.hovering(Vector3(0, 0, -20))
      for
        (setpoint, seconds) <-
          Seq(Setpoint.velocityZ(5, 3, -20) -> 1.5, Setpoint.velocityZ(-2, 6, -20) -> 1.5)
        _ <- 1 to (seconds / stepS).round.toInt
      do quadrotor.step(state, setpoint)
      (state.x, state.y)
    val places     = Seq(2, 4, 8, 16).map(fly) // at 3 ms a step is still near the rotors' lag of 5 ms
    val changes    = places.zip(places.tail).map((a, b) => math.hypot(a._1 - b._1, a._2 - b._2))
    val orders     = changes.zip(changes.tail).map((coarse, fine) => math.log(coarse / fine) / math.log(2))
    val difference = changes.mkString(", ")
    for order <- orders do assertEqualsDouble(order, 1.0, 0.1, s"$orders; differences $difference m")

  test("the reduced model is exact: the number of pieces of a flight does not change it"):
    def fly(pieces: Int): Vector[Double] =
      val vehicle = VelocityResponses.lag(gain = 0.8, lagS = 0.5, deadTimeS = 0.12).create()
      vehicle.start(0, 0, -20)
      for (second, (vx, vy)) <- Seq((10.0, 0.0), (3.0, 9.0), (-5.0, 5.0)).zipWithIndex.map(_.swap) do
        vehicle.act(Action.VelocityAt(vx, vy, Metres(-20)))
        for piece <- 1 to pieces do vehicle.advance(second + piece.toDouble / pieces)
      Vector(vehicle.x, vehicle.y, vehicle.vx, vehicle.vy)
    for pieces <- Seq(7, 1000) do assertClose(fly(pieces), fly(1), 1e-11)
