package skein.report

import skein.flight.VirtualFlights
import skein.loop.{Fallback, LoopKind}
import skein.measure.{FlightSet, FlightSummary}
import skein.scenario.Scenarios
import skein.settings.{FlySettings, SolverChoice}
import skein.signal.LatencyProfile
import skein.units.*

class SolverTableSuite extends munit.FunSuite:
  private given Scenarios = Scenarios.ours

  private def summaries(solver: String): Vector[FlightSummary] =
    val settings = FlySettings(
      List(LoopKind.Predictive),
      List(LatencyProfile.direct),
      Span.ofSeconds(12),
      Span.ofMillis(100),
      seed = 1,
      fallback = Fallback.Hover,
      solver = SolverChoice.parse(solver).toOption
    )
    settings.plans.map(plan =>
      FlightSummary.of(VirtualFlights.fly(settings, plan).fold(fail(_), identity).recorder.recording)
    )

  test(
    "a flight with a remote solver is compared with the loop that decides locally, with the increase"
  ):
    val set   = FlightSet(summaries("link:constant:20ms"))
    val table = SolverTable.of(set)
    assertEquals(table.rows.size, 1)
    val row                          = table.rows.head
    def cell(column: String): String = row(table.header.indexWhere(_.stripPrefix("<") == column))
    assertEquals((cell("loop"), cell("solver")), ("predictive", "link:constant:20ms"))
    assertEquals((cell("added ms p50"), cell("thinking"), cell("missed")), ("20.0", "0", "0"))
    assertEqualsDouble(cell("age at command p50").toDouble - cell("here").toDouble, 20, 5)
    assert(cell("difference").endsWith(" %"), row)
    assertEquals(set.flights.map(_.name), Vector("predictive", "predictive, solver"))
    val other = set.flights.map(one =>
      if one.solver.nonEmpty then one else one.copy(flight = one.flight.copy(period = Span.ofMillis(50)))
    )
    assertEquals(SolverTable.of(FlightSet(other)).rows.map(_.last), Vector(""))
