package ridge

import skein.flight.VirtualFlights
import skein.loop.LoopKind
import skein.scenario.Result
import skein.signal.LatencyProfile

class RidgeSimulation extends munit.FunSuite:
  private def fly(scenario: OverTheRidge, loop: LoopKind = LoopKind.Predictive): Result =
    VirtualFlights.result(scenario, loop, LatencyProfile.vpn, seed = 1).fold(fail(_), identity)

  for loop <- Seq(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive) do
    test(
      s"${loop.label}: both vehicles cross the ridge over a slow link, never " +
        "out of view, no limit is broken, and the flight ends then"
    ):
      val result = fly(OverTheRidge(), loop)
      assert(result.tracks.lastS < 55)
      assertEquals(result.violations.map(_.limit.text), Vector.empty)
      assertEquals(result.value("out of view"), Some(0.0))
      assert(result.value("over after").exists(_ < 60), result.value("over after"))

  test("where the ridge is too steep for a scout, the report names the limit, the scout, and when"):
    val broken = fly(OverTheRidge(crestM = 200, widthM = 10)).violations
    assert(clue(broken.map(_.limit.text)).contains("height above the ground of at least 3 m"))
    for one <- broken do
      assert(one.vehicles.size == 1 && one.fromS <= one.worstAtS && one.worstAtS <= one.toS)
