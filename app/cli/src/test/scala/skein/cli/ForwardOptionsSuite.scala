package skein.cli

import skein.policy.Agent
import skein.scenario.{PaperDuel, Scenario, ScenarioKind, Scenarios}
import skein.units.Span

class ForwardOptionsSuite extends munit.FunSuite:

  private final case class Brief(lastsS: Double = 20) extends Scenario:
    def agents: Vector[Agent]   = PaperDuel().agents
    override def duration: Span = Span.ofSeconds(lastsS)

  private given Scenarios = Scenarios(ScenarioKind(Brief()) +: Scenarios.ours.kinds)

  test("an episode is as long as the scenario's flights, unless an option sets it"):
    assertEquals(ForwardOptions.durationOf("brief", Map.empty), Span.ofSeconds(20))
    assertEquals(ForwardOptions.durationOf("brief", Map("lasts-s" -> "30")), Span.ofSeconds(30))
    assertEquals(ForwardOptions.durationOf("duel", Map.empty), Span.ofSeconds(60))
    // The command reports these when it reads the scenario.
    assertEquals(ForwardOptions.durationOf("brief", Map("lasts-s" -> "long")), Span.ofSeconds(60))
