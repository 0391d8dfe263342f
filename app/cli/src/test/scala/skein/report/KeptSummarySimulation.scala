package skein.report

import skein.flight.VirtualFlights
import skein.loop.LoopKind
import skein.measure.{FlightSet, FlightSummary}
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.Span

/** The summary of a virtual flight's records, which `fly` shows without reading its recording. */
class KeptSummarySimulation extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given Scenarios = PaperReport.scenarios

  test("tables from a flight's records in memory equal those from its recording"):
    val folder   = temporaryFolder()
    val settings = FlySettings(
      List(LoopKind.Stream, LoopKind.Predictive),
      List(LatencyProfile.vpn),
      Span.ofSeconds(12),
      Span.ofMillis(100),
      seed = 5
    )
    val kept   = java.util.concurrent.ConcurrentHashMap[String, FlightSummary]()
    val landed = VirtualFlights
      .fly(settings, settings.plans, folder): (flight, records) =>
        kept.put(flight.plan.id, FlightSummary.of(records.recording)): Unit
      .landed
    val read = Report.read(landed.map(_.plan.file(folder))).fold(errors => fail(errors.mkString), identity)
    val own  = FlightSet(landed.map(flight => kept.get(flight.plan.id)))
    assertEquals(ReportSections.text(own), ReportSections.text(read))
    assertEquals(
      HtmlReport.render(own, ReportSections.of(own)),
      HtmlReport.render(read, ReportSections.of(read))
    )
