package skein.flight

import java.nio.file.Files
import skein.cli.OurScenarios
import skein.loop.{LoopKind, FlightOutcome}
import skein.report.Report
import skein.scenario.{Scenarios, Surround}
import skein.settings.{FlySettings, Wire}
import skein.signal.LatencyProfile
import skein.testing.{Lengthy, Optimised, TemporaryFolders}
import skein.units.*

/** A team over one MAVLink connection, with its report. */
class MavlinkTeamSimulation extends munit.FunSuite, TemporaryFolders, Lengthy, Optimised:
  private given Scenarios = OurScenarios.all

  folder.test("six vehicles on one link surround an evader, and the report shows it"): folder =>
    val scenario = Surround(vehicles = 6)
    val settings = FlySettings(
      List(LoopKind.Predictive),
      List(LatencyProfile.direct),
      Span.ofSeconds(30),
      Span.ofMillis(100),
      seed = 1,
      scenario,
      wire = Wire.Mavlink
    )
    val plan  = settings.plans.last
    val flown = VirtualFlights.fly(settings, plan).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    val file = plan.file(folder)
    assert(flown.recorder.writeTo(file).isRight)
    val set    = Report.read(Seq(file)).fold(errors => fail(errors.toString), identity)
    val result = set.all.head.result.getOrElse(fail("it has no result"))
    assertEquals(result.violations, Vector.empty)
    assert(result.value("off ring").exists(_ < 1), result.measured)
    val page = Files.readString(Report.write(set, folder).fold(fail(_), identity).page)
    assert(page.contains("mavlink"), "the report names the wire")
    for agent <- scenario.agents do assert(page.contains(agent.name), agent.name)
