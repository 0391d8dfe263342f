package @PACKAGE@

import skein.flight.VirtualFlights
import skein.loop.LoopKind
import skein.signal.LatencyProfile

/** Whole flights in virtual time: the same for the same seed, on every machine. */
class @CLASS@Suite extends munit.FunSuite:
  test("the wing keeps behind the leader over a slow link, and no limit is broken"):
    val result = VirtualFlights
      .result(@CLASS@(), LoopKind.Predictive, LatencyProfile.vpn, seed = 1)
      .fold(fail(_), identity)
    assertEqualsDouble(result.value("distance").get, 6, 2)
    assertEquals(result.violations.map(_.limit.text), Vector.empty)
