package skein.flight

import skein.loop.LoopKind
import skein.report.PaperReport
import skein.scenario.{PaperDuel, Scenarios}
import skein.testing.Unhurried

/** Real sockets, real time and many threads; virtual time has only one. */
class ReplayLiveSuite extends munit.FunSuite, Unhurried:
  private given Scenarios = PaperReport.scenarios

  test("live loops replay to equal decisions, also futures on several threads"):
    val loops    = List(LoopKind.Futures, LoopKind.Sequential, LoopKind.Stream, LoopKind.Predictive)
    val settings = TwinFlights.settings(loops, seconds = 6).copy(scenario = PaperDuel(pairs = 2))
    TwinFlights.inFolder: folder =>
      assertEquals(TwinFlights.flyLive(settings, settings.plans, folder), Right(()))
      for plan <- settings.plans do
        val replayed = Replayed.of(plan.file(folder)).fold(fail(_), identity)
        assertEquals(replayed.decidedAgain, None, plan.id)
        // An idle machine makes some 200, a busy one a tenth of that.
        assert(replayed.decisions > 10, s"${plan.id}: ${replayed.decisions} decisions")
