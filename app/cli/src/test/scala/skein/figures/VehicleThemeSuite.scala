package skein.figures

import skein.plot.Colour
import skein.policy.{Agent, Role}
import skein.scenario.*

class VehicleThemeSuite extends munit.FunSuite:
  private def strokes(scenario: Scenario) = VehicleTheme.of(scenario, 1)

  private final case class OfRoles(roles: String*) extends Scenario:
    def agents: Vector[Agent] =
      roles.toVector.zip(Formation(vehicles = roles.size).agents).map: (role, agent) =>
        agent.copy(role = Role(role))

  test("of several vehicles that are alone in their roles, only the first is grey"):
    val two = strokes(OfRoles("Leader", "Wing"))
    assertEquals(two.head.colour, Colour(0x404040))
    assertEquals(two(1).colour, Colour(0x0072b2))
    assertEquals(strokes(OfRoles("Scout", "Scout", "Leader")).last.colour, Colour(0x404040))
    assertEquals(strokes(OfRoles("Leader")).head.colour, Colour(0x0072b2))

  test("no two vehicles of a scenario look alike, even of a hundred"):
    val scenarios =
      Seq(Surround(vehicles = 6), Formation(vehicles = 9), Convoy(), Forest(), Formation(vehicles = 100))
    for scenario <- scenarios do
      assertEquals(strokes(scenario).distinct.size, scenario.agents.size, scenario.name)
    assert(VehicleTheme.Most >= 100, VehicleTheme.Most)

  test("vehicles of one shade look alike, such as those of a crossing's stream"):
    val lines = strokes(Crossing(vehicles = 12, streams = 4))
    assertEquals(lines.distinct, lines.take(4))
    assertEquals(lines(5), lines(1))
