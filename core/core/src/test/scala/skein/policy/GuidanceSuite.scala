package skein.policy

import skein.signal.SplitMix64

/** The defining properties of pursuers and evaders under the game's ideal kinematics, in which the velocity
  * equals the command.
  */
class GuidanceSuite extends munit.FunSuite:
  private val fast = 1e6 // a turn rate that never limits

  private final case class Mover(x: Double, y: Double, headingRad: Double, speed: Double):
    def moved(dt: Double): Mover =
      copy(x = x + speed * math.cos(headingRad) * dt, y = y + speed * math.sin(headingRad) * dt)

  private def steered(policy: HeadingPolicy, own: Mover, other: Mover, dt: Double): Mover =
    def vx(m: Mover) = m.speed * math.cos(m.headingRad)
    def vy(m: Mover) = m.speed * math.sin(m.headingRad)
    own.copy(headingRad =
      policy.heading(
        other.x - own.x,
        other.y - own.y,
        vx(other) - vx(own),
        vy(other) - vy(own),
        own.headingRad,
        other.headingRad,
        dt
      )
    )

  /** Simulates pursuer and evader until they are within the distance of one step, or until the time has
    * elapsed.
    */
  private def chase(
      pursuing: HeadingPolicy,
      evading: HeadingPolicy,
      pursuer: Mover,
      evader: Mover,
      dt: Double,
      untilS: Double
  ) =
    Iterator
      .iterate((pursuer, evader)): (p, e) =>
        (steered(pursuing, p, e, dt).moved(dt), steered(evading, e, p, dt).moved(dt))
      .take((untilS / dt).toInt)
      .toVector

  private def distance(p: Mover, e: Mover) = math.hypot(p.x - e.x, p.y - e.y)

  test("pure pursuit points at the target as soon as its turn rate allows"):
    assertEqualsDouble(PurePursuit(fast).heading(3, 4, 0, 0, 0.2, 0, 0.1), math.atan2(4, 3), 1e-12)
    assertEqualsDouble(PurePursuit(1.0).heading(0, 5, 0, 0, 0, 0, 0.1), 0.1, 1e-12)
    // The shorter way, also from a heading of many turns.
    assertEqualsDouble(PurePursuit(1.0).heading(1, -1, 0, 0, 8 * math.Pi, 0, 0.1), 8 * math.Pi - 0.1, 1e-12)

  test(
    "against a target that does not manoeuvre, proportional navigation ends on a straight line that meets it"
  ):
    val flown =
      chase(ProportionalNavigation(4, 10), KeepHeading, Mover(0, 0, 0.6, 10), Mover(40, 5, 1.9, 5), 0.005, 12)
    val closest = flown.indexWhere((pursuer, evader) => distance(pursuer, evader) < 0.1)
    assert(closest > 0, flown.map(distance(_, _)).min)
    val late = flown.slice(closest / 2, closest - 100).map(_._1.headingRad)
    assert(late.max - late.min < 0.02, s"${late.min} to ${late.max}")

  test(
    "proportional navigation turns at the gain times the line of sight's rate, and towards a target that " +
      "gets away"
  ):
    // Closing at 10 m/s with 1 m/s across over 20 m: the line of sight turns 0.05 rad/s.
    val rate = (ProportionalNavigation(3, fast).heading(20, 0, -10, 1, 0.3, 0, 0.1) - 0.3) / 0.1
    assertEqualsDouble(rate, 3 * 0.05, 1e-12)
    assertEqualsDouble(ProportionalNavigation(3, 1).heading(-20, 1, -5, 0, 0, 0, 0.1), 0.1, 1e-12)

  test("lead pursuit meets a target on a straight course at the computed point, on a straight line"):
    val source = SplitMix64(1)
    for case_ <- 1 to 20 do
      val target =
        Mover(30 * source.nextDouble() - 15, 20 + 10 * source.nextDouble(), 7 * source.nextDouble(), 5)
      // |target + v t| = 10 t
      val (vx, vy) = (5 * math.cos(target.headingRad), 5 * math.sin(target.headingRad))
      val along    = target.x * vx + target.y * vy
      val square   = target.x * target.x + target.y * target.y
      val meetS    = (along + math.sqrt(along * along + 75 * square)) / 75
      val wanted   = math.atan2(target.y + vy * meetS, target.x + vx * meetS)
      val heading  = LeadPursuit(0.5, 1, fast).heading(target.x, target.y, 0, 0, 0, target.headingRad, 0.1)
      assertEqualsDouble(math.IEEEremainder(heading - wanted, 2 * math.Pi), 0, 1e-9, s"case $case_")
      val dt    = meetS / 1000
      val flown = chase(LeadPursuit(0.5, 1, fast), KeepHeading, Mover(0, 0, 0, 10), target, dt, meetS * 0.999)
      assert(distance(flown.last._1, flown.last._2) < 0.1, s"case $case_: ${flown.last}")

  test("lead pursuit with a lead of 0 is pure pursuit"):
    val lead = LeadPursuit(0.5, lead = 0, 1).heading(7, -3, 1, 2, 0.4, 2.2, 0.1)
    assertEqualsDouble(lead, PurePursuit(1).heading(7, -3, 1, 2, 0.4, 2.2, 0.1), 1e-12)

  test(
    "the chauffeur's evader keeps one direction, the line of the chase, while the pursuer turns hard and " +
      "dashes"
  ):
    val evader = ChauffeurEvader(8, 0.5, dodgeM = 0)
    for (x, y) <- Seq((20.0, 15.0), (-12.0, 18.0), (-30.0, -9.0), (25.0, -2.0)) do
      val flown    = chase(PurePursuit(1.25), evader, Mover(0, 0, 0, 10), Mover(x, y, 0, 5), 0.001, 3)
      val headings = flown.drop(1).map(_._2.headingRad)
      val bend     = headings.map(h => math.abs(math.IEEEremainder(h - headings.head, 2 * math.Pi))).max
      // Pure pursuit turns as hard as it can until the target is ahead, which is the end of the hard turn but
      // for the target's own way meanwhile.
      val turning = flown.zip(flown.drop(1)).takeWhile((a, b) =>
        math.abs(b._1.headingRad - a._1.headingRad) > 0.00125 - 1e-9
      ).size
      val hardBend =
        headings.take(turning).map(h => math.abs(math.IEEEremainder(h - headings.head, 2 * math.Pi)))
      assert(hardBend.forall(_ < 1e-2), s"from ($x, $y): ${hardBend.max} rad of $bend")

  test("inside the pursuer's turning circle the chauffeur's evader heads for the centre"):
    for side <- Seq(1, -1) do
      // The evader is 4 m to the side of the pursuer, which faces 0.7 rad.
      val evader =
        ChauffeurEvader().heading(side * 4 * math.sin(0.7), -side * 4 * math.cos(0.7), 0, 0, 0, 0.7, 0.1)
      assertEqualsDouble(evader, 0.7 + side * math.Pi / 2, 1e-12)

  test(
    "close ahead, the chauffeur's evader breaks away at a right angle and keeps that course without " +
      "crossing the bow"
  ):
    def ahead(right: Double, own: Double) = ChauffeurEvader().heading(-3, -right, 0, 0, own, 0, 0.1)
    assertEqualsDouble(ahead(0.1, own = 0.2), math.Pi / 2, 1e-12)
    assertEqualsDouble(ahead(-0.1, own = 0.2), -math.Pi / 2, 1e-12)
    assertEquals(ahead(0.1, own = 1.3), 1.3)
    assertEquals(ahead(-0.1, own = 1.3), 1.3)
    assertEqualsDouble(ahead(-0.1, own = 0.9), math.Pi / 2, 1e-12)

  test(
    "in the ideal game the chauffeur's evader slips by at the threshold radius, and is run over without " +
      "dodging"
  ):
    val (radius, ratio) = (8.0, 0.5)
    val threshold       = radius * (math.sqrt(1 - ratio * ratio) + ratio * math.asin(ratio) - 1)
    assertEqualsDouble(threshold, 1.0226, 1e-4)
    def closest(dodgeM: Double, x: Double, y: Double) =
      val evader = ChauffeurEvader(radius, ratio, dodgeM)
      chase(
        PurePursuit(10 / radius),
        evader,
        Mover(0, 0, 0, 10),
        Mover(x, y, 0, 5),
        0.002,
        8
      ).map(distance(_, _)).min
    for (x, y) <- Seq((20.0, 0.0), (20.0, 3.0), (15.0, -10.0)) do
      assertEqualsDouble(closest(ratio * radius, x, y), threshold, 0.02, s"from ($x, $y)")
      assert(closest(0, x, y) < 0.1, s"from ($x, $y)")

  test("in a mirrored situation every policy makes the mirrored decision"):
    val source   = SplitMix64(3)
    val policies =
      Seq(
        PurePursuit(1),
        ProportionalNavigation(3, 1),
        LeadPursuit(0.5, 1, 1),
        ChauffeurPursuer(),
        ChauffeurEvader()
      )
    for policy <- policies; _ <- 1 to 200 do
      val v        = Vector.fill(6)(20 * source.nextDouble() - 10)
      val here     = policy.heading(v(0), v(1), v(2), v(3), v(4), v(5), 0.1)
      val mirrored = policy.heading(v(0), -v(1), v(2), -v(3), -v(4), -v(5), 0.1)
      assertEqualsDouble(math.IEEEremainder(here + mirrored, 2 * math.Pi), 0, 1e-9, s"$policy at $v")

  test(
    "a policy with a limited turn rate turns by the elapsed time: deciding twice as often turns no faster"
  ):
    val policies = Seq(
      PurePursuit(1),
      ProportionalNavigation(3, 1),
      LeadPursuit(0.5, 1, 1),
      ChauffeurPursuer(turnRateRadPerS = 1),
      NeuralPolicy(NeuralShape(Vector(3)), Vector.tabulate(19)(i => math.sin(i)), 1)
    )
    for policy <- policies do
      def turned(steps: Int) = policy.heading(0, 30, -1, -2, 0, 1, 0.4 / steps) * steps
      assertEqualsDouble(turned(2), turned(1), 1e-12, policy.toString)
      assert(math.abs(turned(1)) <= 0.4 + 1e-12 && turned(1) != 0, policy.toString)
