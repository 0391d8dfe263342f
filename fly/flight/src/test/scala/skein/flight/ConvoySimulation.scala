package skein.flight

import skein.loop.{LoopKind, FlightOutcome}
import skein.record.{EventKind, Recording}
import skein.scenario.{Convoy, Result, Tracks}
import skein.measure.RecordedTracks
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.{Lengthy, Optimised}
import skein.units.*
import skein.vehicle.VehicleKind

/** Two cars and three drones, in virtual time. */
class ConvoySimulation extends munit.FunSuite, Lengthy, Optimised:
  /** Loops that cannot read five vehicles in sequence over a VPN in time. */
  private val overtaxed = Set(LoopKind.Sequential, LoopKind.Futures)

  private def flown(loop: LoopKind, link: LatencyProfile): (Recording, Result) =
    val duration = Span.ofSeconds(if overtaxed(loop) then 20 else 25)
    val settings = FlySettings(List(loop), List(link), duration, Span.ofMillis(100), 1, Convoy())
    val flight   = VirtualFlights.fly(settings, settings.plans.head).fold(fail(_), identity)
    assertEquals(flight.landed.outcome, FlightOutcome.Completed)
    val recording = flight.recorder.recording
    (recording, Result.of(Convoy(), Tracks.of(RecordedTracks.of(recording)).get))

  private lazy val predictive = flown(LoopKind.Predictive, LatencyProfile.vpn)

  for loop <- LoopKind.values do
    val link = if loop == LoopKind.Paused then LatencyProfile.none else LatencyProfile.vpn
    test(s"drones escort cars round a circuit: ${loop.label} over ${link.name}"):
      val (recording, result) = if loop == LoopKind.Predictive then predictive else flown(loop, link)
      def value(name: String) = result.value(name).get
      if !overtaxed(loop) then
        assert(value("off places") < 2.5, result.measured)
        assertEqualsDouble(value("between cars"), 12, 1.5)
        assertEquals(result.violations, Vector.empty)
      val usual  = Set(EventKind.Dropped, EventKind.Skipped, EventKind.Cancelled)
      val failed = recording.events.filterNot(event => usual(event.kind))
      assert(failed.isEmpty, failed.take(5).mkString("\n"))
      for (name, commands) <- recording.commands.groupBy(_.vehicle) do
        assert(commands.size > 30, s"$name: ${commands.size} commands")
        val ended = recording.acknowledgements.filter(_.vehicle == name)
        assertEquals(ended.size, commands.size, name)
      val cars = Convoy().agents.filter(_.kind == VehicleKind.Car)
      assertEquals(recording.heading.parametersOf("kind"), cars.map(_.name -> "Car").toMap)
      // It stays on the ground.
      val lead = recording.readings.filter(_.vehicle == "Lead").map(_.state.value)
      assert(lead.forall(_.positionNed.z == 0))
      assert(lead.last.positionNed.x > 20 || lead.last.positionNed.y > 10, lead.last)

  test("predictive predicts a car better than constant velocity"):
    val (recording, _) = predictive
    val errors         = recording.predictions.filter(_.vehicle == "Lead").map(_.error.value)
    assert(errors.size > 100, errors.size)
    assert(errors.sorted.apply(errors.size / 2) < 0.1, errors.sorted.apply(errors.size / 2))
