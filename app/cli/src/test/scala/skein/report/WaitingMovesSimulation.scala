package skein.report

import skein.flight.VirtualFlights
import skein.loop.LoopKind
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.Span

class WaitingMovesSimulation extends munit.FunSuite:
  private given Scenarios = Scenarios.ours

  test("moves that wait for answers over a long round trip are reported, with the setting that allows more"):
    def remarks(moves: Int, roundTripMs: Int) =
      val link = LatencyProfile.parse(
        s"constant:${roundTripMs}ms",
        Left(_)
      ).fold(error => fail(error.message), identity)
      val settings = FlySettings(
        List(LoopKind.Predictive),
        List(link),
        Span.ofSeconds(6),
        Span.ofMillis(100),
        seed = 1,
        movesInFlight = moves
      )
      val flown = VirtualFlights.fly(settings, settings.plans.last).fold(fail(_), identity)
      SummaryTables.remarks(Report.of(Seq(flown.recorder.recording)))
    val told = remarks(2, 200)
    assert(clue(told).exists(_.matches(".* moved each vehicle every (19|20). ms, not every 100: .*")))
    assert(told.exists(_.contains("--moves-in-flight 6")))
    assertEquals(remarks(6, 200), Vector.empty)
    assertEquals(remarks(2, 90), Vector.empty)
