package skein.policy

import skein.scenario.PaperDuel

class PaperPolicySuite extends munit.FunSuite:

  private def pursuer(dx: Double, dy: Double, heading: Double, elapsedS: Double) =
    PaperPursuer().heading(dx, dy, 0, 0, heading, 0, elapsedS)

  private def evader(x: Double, y: Double, pursuerHeading: Double) =
    // The evader at (x, y) in the frame of a pursuer at the origin.
    val dx = -(x * math.cos(pursuerHeading) - y * math.sin(pursuerHeading))
    val dy = -(x * math.sin(pursuerHeading) + y * math.cos(pursuerHeading))
    PaperEvader().heading(dx, dy, 0, 0, 0, pursuerHeading, 0.1)

  test("the pursuer turns towards the evader by one radian per second of elapsed time"):
    assertEqualsDouble(pursuer(20, 5, 0, 0.1), 0.1, 1e-15)
    assertEqualsDouble(pursuer(20, -5, 0, 0.1), -0.1, 1e-15)
    assertEqualsDouble(pursuer(20, 5, 0, 0.05) * 2, pursuer(20, 5, 0, 0.1), 1e-15)

  test(
    "the pursuer keeps its heading if the evader is exactly ahead, and turns right if it is exactly behind"
  ):
    assertEquals(pursuer(20, 0, 0, 0.1), 0.0)
    assertEqualsDouble(pursuer(-20, 0, 0, 0.1), 0.1, 1e-15)

  test("as published, the pursuer turns a tenth of a radian per decision, however often it decides"):
    val heading = PaperPursuer.asPublished.heading(20, 5, 0, 0, 0, 0, 0.001)
    assertEqualsDouble(heading, 0.1, 1e-15)

  test("a distant evader runs along the line of sight"):
    assertEqualsDouble(evader(21, 0, 0.3), 0.3, 1e-12)
    assertEqualsDouble(evader(20, 10, 0), math.atan2(10, 20), 1e-12)

  test("an evader near the pursuer breaks away at a right angle"):
    assertEqualsDouble(evader(10, 0, 0.2), 0.2 + math.Pi / 2, 1e-12)

  test("an evader inside a turning circle heads past the opposite circle's centre"):
    assertEqualsDouble(evader(3, 4, 0.2), 0.2 + math.atan2(12, 3), 1e-12)
    assertEqualsDouble(evader(3, -4, 0.2), 0.2 + math.atan2(-12, 3), 1e-12)

  test("a rotation of the world rotates the decisions of both policies"):
    for turn <- Seq(0.0, 0.7, -2.0, 3.1) do
      val (dx, dy) = (12 * math.cos(turn) - 3 * math.sin(turn), 12 * math.sin(turn) + 3 * math.cos(turn))
      assertEqualsDouble(pursuer(dx, dy, 0.4 + turn, 0.1) - turn, pursuer(12, 3, 0.4, 0.1), 1e-12)
      assertEqualsDouble(math.cos(evader(10, 1, turn) - turn - evader(10, 1, 0)), 1.0, 1e-12)

  test("each agent plays against the nearest of the other role"):
    val scenario = PaperDuel(3).fleet
    val start    = (i: Int) => scenario.agents(i).startPositionNed
    for i <- scenario.agents.indices do
      assertEquals(scenario.opponentOf(i, start), if i % 2 == 0 then i + 1 else i - 1)

  test("a scenario without opponents is refused"):
    intercept[IllegalArgumentException](Fleet(PaperDuel().fleet.agents.take(1)))
