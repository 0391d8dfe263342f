package skein.scenario

import skein.policy.Role
import skein.units.*

/** Starts and goals of the vehicles in Skein's scenarios. */
class OurScenariosSuite extends munit.FunSuite:

  private def startsM(scenario: Scenario) =
    scenario.agents.map(agent =>
      (agent.startPositionNed.x, agent.startPositionNed.y, agent.startPositionNed.z)
    )

  test("duels start 21 m apart, each pair 60 m east of the last, with numbered names if there are several"):
    assertEquals(startsM(PaperDuel()), Vector((21.0, 0.0, -20.0), (0.0, 0.0, -20.0)))
    assertEquals(startsM(PaperDuel(pairs = 3, altitudeM = 7)).last, (0.0, 120.0, -7.0))
    assertEquals(PaperDuel().agents.map(_.name), Vector("Evader", "Pursuer"))
    assertEquals(
      PaperDuel(pairs = 2).agents.map(_.name),
      Vector("Evader1", "Pursuer1", "Evader2", "Pursuer2")
    )
    assertEquals(PaperDuel().agents.map(_.speed.value), Vector(5.0, 10.0))
    assertEquals(PaperDuel(asPublished = true).title, "duel, as published")
    assertEquals((PaperDuel().crowded(9).pairs, PaperDuel(pairs = 6).crowded(9).pairs), (4, 6))
    assertEquals(PaperDuel(pairs = 51).mistakes, Seq("pairs: expected 1 to 50, got 51"))

  test("in surround, pursuers start in a line, half a ring's radius apart, 30 m south of the evader"):
    assertEquals(
      startsM(Surround(vehicles = 4, ringM = 8)),
      Vector((30.0, 0.0, -5.0), (0.0, -4.0, -5.0), (0.0, 0.0, -5.0), (0.0, 4.0, -5.0))
    )
    assertEquals(Surround().agents.map(_.role).distinct, Vector(Role.Evader, Role.Pursuer))
    assert(Surround(vehicles = 6).note.contains("72° is even"), Surround().note)
    assert(Surround(ringM = 4.185774264457861).note.contains("the ring of 4.19 m,"))
    assertEquals(Surround(vehicles = 2).mistakes, Seq("vehicles: expected 3 to 100, got 2"))
    assertEquals((0 to 3).map(Surround().shade), Seq(0, 0, 1, 2))

  test("lengths in notes have at most three digits"):
    assert(Surround().note.contains("the ring of 8 m,"), Surround().note)
    assert(Crossing(minimumM = 2.5).note.contains("minimum of 2.5 m; arrived: within 3 m"), Crossing().note)
    assert(Formation().note.contains("first 10 s:"), Formation().note)
    val scenarios = Seq(Convoy(), Forest(), Surround(), Crossing(), Formation())
    assertEquals(scenarios.filter(_.note.contains(".0 ")).map(_.note), Nil)

  test("a formation starts as a wedge behind its leader, right and left in turn"):
    assertEquals(
      Formation(spacingM = 3).slots,
      Vector((-3.0, 3.0), (-3.0, -3.0), (-6.0, 6.0), (-6.0, -6.0))
    )
    assertEquals(
      startsM(Formation(vehicles = 3)),
      Vector((0.0, 0.0, -5.0), (-4.0, 4.0, -5.0), (-4.0, -4.0, -5.0))
    )
    assertEquals(Formation(straightM = 0, lagS = 0).mistakes, Nil)
    assertEquals(Formation(radiusM = 0).mistakes, Seq("radiusM: expected more than 0, got 0.0"))

  test("in crossing, streams keep to the right, and all vehicles fly equally far"):
    val crossing = Crossing(vehicles = 5, streams = 2, spacingM = 6, entryM = 25, laneM = 4)
    val rounded  = (m: Double) => (m * 1e6).round / 1e6
    // Northward ones are 4 m east of the middle; eastward ones 4 m south of it.
    assertEquals(
      startsM(crossing).map((north, east, _) => (rounded(north), rounded(east))),
      Vector((-25.0, 4.0), (-4.0, -25.0), (-31.0, 4.0), (-4.0, -31.0), (-37.0, 4.0))
    )
    assertEquals(
      crossing.goals.map((north, east) => (rounded(north), rounded(east))),
      Vector((37.0, 4.0), (-4.0, 31.0), (31.0, 4.0), (-4.0, 25.0), (25.0, 4.0))
    )
    assertEquals((0 to 4).map(crossing.shade), Seq(0, 1, 0, 1, 0))
    assertEquals(Crossing(laneM = 0, marginM = 0).mistakes, Nil)

  test("a scenario's name is that of its class in words, and planar scenarios steer horizontally"):
    assertEquals(Seq(PaperDuel(), Surround(), Crossing()).map(_.name), Seq("duel", "surround", "crossing"))
    assertEquals(Scenario.worded("OverTheRidge"), "over-the-ridge")
    assert(Seq(PaperDuel(), Surround(), Formation(), Crossing()).forall(_.isPlanar))
    assertEquals(Surround().duration, Span.ofSeconds(60))
    assertEquals(Scenarios(ScenarioKind(Surround())).firstWithoutGame, Some("surround"))
    assertEquals(Scenarios.ours.firstWithoutGame, None)
    assertEquals(
      Scenarios(ScenarioKind(Surround())).kind("ring").left.toOption,
      Some("expected surround, got 'ring'")
    )
