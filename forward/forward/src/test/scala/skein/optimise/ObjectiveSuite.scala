package skein.optimise

import skein.forward.{DelayTable, LoopTiming, Pair, ScoredRollout, VelocityResponses}
import skein.lanes.{TeamBatch, TeamCandidate}
import skein.policy.{PaperPursuer, Role}
import skein.simd.WorldRandom

class ObjectiveSuite extends munit.FunSuite:
  private def read(text: String, role: Role = Role.Pursuer): Objective =
    Objective.ofRole(text, role).fold(mistake => fail(mistake), identity)

  test("a weighted sum is read term by term, and its text is read back"):
    val objective = read("0.7*last10s + 0.3*effort-2e-1 * capture(4, 20)")
    assertEquals(
      objective.terms,
      Vector(0.7 -> DistanceTerm.Last10s, 0.3 -> EffortTerm(1), -0.2 -> DistanceTerm.Capture(4, 20))
    )
    assertEquals(objective.direction, Direction.Minimise)
    assertEquals(read(objective.text), objective)

  test("a single term has the role's direction unless another is stated"):
    assertEquals(read("last10s").direction, Direction.Minimise)
    assertEquals(read("last10s", Role.Evader).direction, Direction.Maximise)
    assertEquals(read("capture(4, 20)").direction, Direction.Maximise)
    assertEquals(read("captureTime(4)").direction, Direction.Minimise)
    assertEquals(read("effort", Role.Evader).direction, Direction.Minimise)
    assertEquals(read("maximise last10s").direction, Direction.Maximise)
    assertEquals(read("minimize 2*min + mean", Role.Evader).direction, Direction.Minimise)

  for
    (text, place, expected) <- Seq(
      ("", "character 1", "MEASURE"),
      ("minimise 0.5*nosuch", "character 14", "last10s"),
      ("last10s min", "character 9", "+ or -"),
      ("last10s + ", "character 9", "+ or -"),
      ("capture(4)", "character 1", "capture(RADIUS_M, WITHIN_S)"),
      ("capture(4, x)", "character 1", "capture(RADIUS_M, WITHIN_S)"),
      ("capture(-4, 20)", "above 0 and below a million", "got 'capture(-4, 20)'"),
      ("captureTime(1e7)", "above 0 and below a million", "got 'captureTime(1e7)'"),
      ("captureTime(-1)", "character 1", "captureTime(RADIUS_M)")
    )
  do
    test(s"'$text' is refused, with the position and what was expected"):
      val mistake = Objective.ofRole(text, Role.Pursuer).left.getOrElse("accepted")
      assert(mistake.contains(place) && mistake.contains(expected), mistake)

  test("captures, their times and efforts equal those of the scalar reference"):
    val duel     = Pair.paper.copy(durationS = 20)
    val model    = VelocityResponses.lag(0.9, 0.8, 0.05)
    val pursuers = Vector(PaperPursuer(0.4), PaperPursuer(1.0), PaperPursuer(1.8))
    val timing   = LoopTiming.Futures()
    val key      = WorldRandom.key(1, 0, 0)
    for pursuer <- pursuers do
      val own = duel.copy(pursuer = duel.pursuer.copy(policy = pursuer))
      val one = ScoredRollout(own.engagement, timing, DelayTable.direct, model).fly(key, 4.5)
      val far = ScoredRollout(own.engagement, timing, DelayTable.direct, model).fly(key, 6)
      def value(text: String, role: Role = Role.Pursuer) =
        val objective = read(text, role)
        val candidate = TeamCandidate(own.engagement, objective.judged(20, timing.periodS))
        val evaluator =
          TeamEvaluator(TeamBatch(timing, model, 1), _ => candidate, DelayTable.direct, objective, 1)
        evaluator.tallies(Vector(Vector.empty), 0 until 1).head.mean
      assertEqualsDouble(value("captureTime(4.5)"), one.captureS.min(20), 1e-5)
      assertEqualsDouble(value("capture(4.5, 8)"), if one.captureS <= 8 then 1 else 0, 0)
      assertEqualsDouble(
        value("captureTime(4.5) + captureTime(6)"),
        one.captureS.min(20) + far.captureS.min(20),
        1e-5
      )
      assertEqualsDouble(value("effort"), one.pursuerEffortRad, 1e-4)
      assertEqualsDouble(value("effort", Role.Evader), one.evaderEffortRad, 1e-4)
      assertEqualsDouble(
        value("2*min - 0.5*mean + last10s"),
        2 * one.minDistanceM - 0.5 * one.meanDistanceM + one.meanLast10sM,
        1e-4
      )

  test("the tallies of parts combine to the tally of the whole"):
    val values = Vector.tabulate(20)(i => math.sin(i) * i)
    val whole  = RunningStats.of(20)(values)
    val parts  = RunningStats.of(7)(values) + RunningStats.of(13)(i => values(i + 7))
    assertEquals(parts.count, 20)
    assertEqualsDouble(parts.mean, whole.mean, 1e-12)
    assertEqualsDouble(parts.sd, whole.sd, 1e-12)
    val mean = values.sum / 20
    assertEqualsDouble(whole.sd, math.sqrt(values.map(v => (v - mean) * (v - mean)).sum / 19), 1e-12)

  test("the interval of a mean is by Student's distribution"):
    def width(count: Int) =
      val stats = RunningStats.of(count)(_ % 2)
      stats.halfWidth95 / (stats.sd / math.sqrt(count))
    assertEquals(RunningStats.of(1)(_ => 3).halfWidth95, Double.PositiveInfinity)
    assertEqualsDouble(width(2), 12.706, 1e-9)
    assertEqualsDouble(width(31), 2.042, 1e-9)
    assertEqualsDouble(width(32), 2.0395, 1e-4)

  test("a capture within the limit counts, and one a period later does not"):
    val capture = DistanceTerm.Capture(4, 7.3)
    for (captureS, expected) <- Seq(7.2 -> 1.0, 7.3 -> 1.0, 73 * 0.1 -> 1.0, 7.4 -> 0.0) do
      assertEquals(capture.value(_ => captureS.toFloat, 20), expected, s"$captureS s")
