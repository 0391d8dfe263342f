package skein.flight

import skein.loop.{FlightOutcome, Knowledge, LoopKind}
import skein.measure.PredictionErrors
import skein.record.MemoryRecorder
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.*

/** The paper's duel in virtual time, with controllers that know only the other's positions. */
class KnowledgeSimulation extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given Scenarios = Scenarios.ours

  private def settings(loop: LoopKind, inPacket: Boolean = false) = FlySettings(
    List(loop),
    List(LatencyProfile.vpn),
    duration = Span.ofSeconds(20),
    period = Span.ofMillis(100),
    seed = 1,
    planInPacket = inPacket,
    knows = Knowledge.Positions
  )

  private def fly(settings: FlySettings): MemoryRecorder =
    val flown = VirtualFlights.fly(settings, settings.plans.head).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    flown.recorder

  private def errorP95M(of: PredictionErrors): Double =
    val errors = of.samples.map(_._2).sorted
    assert(errors.sizeIs > 100, s"${errors.size} predictions were verified")
    errors(errors.size * 95 / 100)

  for inPacket <- Seq(false, true) do
    test(
      s"the decider is predicted by its model, the other from its readings; plans in packets: $inPacket"
    ):
      val known                   = settings(LoopKind.Predictive, inPacket).copy(knows = Knowledge.All)
      def errors(of: FlySettings) = PredictionErrors.of(fly(of).recording, isDuel = true).get
      val (told, blind)           = (errors(known), errors(settings(LoopKind.Predictive, inPacket)))
      assert(errorP95M(told.own) < 0.01 && errorP95M(told.others) < 0.01, "all known")
      assert(errorP95M(blind.own) < 0.01, s"own ${errorP95M(blind.own)} m")
      assert(errorP95M(blind.others) > 0.02, s"others ${errorP95M(blind.others)} m")

  folder.test("every loop's flight replays to equal decisions"): folder =>
    for loop <- Seq(LoopKind.Paused, LoopKind.Sequential, LoopKind.Stream, LoopKind.Predictive) do
      val flight = settings(loop).copy(duration = Span.ofSeconds(8))
      val file   = flight.plans.head.file(folder)
      assert(fly(flight).writeTo(file).isRight)
      val replayed = Replayed.of(file).fold(fail(_), identity)
      assertEquals((replayed.decidedAgain, replayed.isSame), (None, true), loop.label)
