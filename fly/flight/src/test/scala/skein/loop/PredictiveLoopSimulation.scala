package skein.loop

import skein.signal.LatencyProfile
import skein.testing.Unhurried

class PredictiveLoopSimulation extends munit.FunSuite, Unhurried:
  private val seeds = 1L to 5L

  private def deviation(
      kind: LoopKind,
      link: LatencyProfile,
      settings: LoopSettings = LoopSettings()
  ): Double =
    val duels = seeds.map(VirtualDuel.fly(kind, link, _, settings))
    duels.foreach(duel => assertEquals(duel.outcome, FlightOutcome.Completed))
    duels.map(_.distanceM).sum / duels.size / VirtualDuel.truth.distanceM - 1

  test("the paused flight's distance is the reference's 8.31 m"):
    assertEqualsDouble(VirtualDuel.truth.distanceM, 8.31, 0.05)

  for (link, bound) <-
      Seq(LatencyProfile.none -> 0.005, LatencyProfile.direct -> 0.015, LatencyProfile.vpn -> 0.02)
  do
    test(s"over ${link.name} predictive flies within ${bound * 100} % of the paused flight"):
      val off = deviation(LoopKind.Predictive, link)
      assert(math.abs(off) < bound, s"seeds $seeds: ${off * 100} %")

  test(
    "at a constant 200 ms each way predictive flies within 2 % if enough moves may be in flight"
  ):
    val (link, settings) = (VirtualDuel.constant(400), LoopSettings(movesInFlight = 6))
    val off              = deviation(LoopKind.Predictive, link, settings)
    val without          = deviation(LoopKind.Stream, link, settings)
    assert(math.abs(off) < 0.02, s"seeds $seeds: ${off * 100} %")
    assert(without > 0.3, s"seeds $seeds: stream is off by no more than ${without * 100} %")

  test("nine of ten predictions of the deciding vehicle are within a centimetre, over vpn"):
    for seed <- seeds do
      val errors = VirtualDuel.fly(LoopKind.Predictive, LatencyProfile.vpn, seed).predictionErrors(own = true)
      assert(errors.size > 1000, s"seed $seed: only ${errors.size} predictions were verified")
      assert(errors((errors.size * 9) / 10) < 0.01, s"seed $seed")

  test("equal seeds give equal recordings"):
    def duel() = VirtualDuel.fly(LoopKind.Predictive, LatencyProfile.vpn, 7).recording
    assertEquals(duel(), duel())
