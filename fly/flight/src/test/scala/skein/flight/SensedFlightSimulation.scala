package skein.flight

import skein.loop.{FlightOutcome, LoopKind}
import skein.measure.{RecordedTracks, RoundTripTrace}
import skein.record.{EventKind, EventSubject, Recording}
import skein.settings.*
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*
import skein.vehicle.SensorNoise

/** Flights by readings that have errors. */
class SensedFlightSimulation extends munit.FunSuite, Unhurried:
  private def flown(
      sensors: String,
      loop: LoopKind = LoopKind.Predictive,
      seconds: Double,
      wire: Wire = Wire.AirSim
  ): VirtualFlightResult =
    val settings = FlySettings(
      List(loop),
      List(LatencyProfile.vpn),
      Span.ofSeconds(seconds),
      Span.ofMillis(100),
      seed = 5,
      sensors = Some(SensorNoise.parse(sensors).fold(fail(_), identity)),
      wire = wire
    )
    VirtualFlights.fly(settings, settings.plans.head).fold(fail(_), identity)

  /** The errors of readings on each axis, against the recorded truth, m. */
  private def errorsM(recording: Recording): Vector[Double] =
    val tracks = RecordedTracks.of(recording).map(track => track.vehicle -> track).toMap
    recording.readings.flatMap: reading =>
      val track = tracks(reading.vehicle)
      import reading.state.validAt
      if validAt < track.from || validAt > track.to then Vector.empty
      else
        val off = reading.state.value.positionNed - track.at(validAt)
        Vector(off.x, off.y, off.z)

  private def sd(values: Seq[Double]) = math.sqrt(values.map(x => x * x).sum / values.size)

  test("readings have the stated errors, are missing as often as stated, and the truth is recorded apart"):
    val recording = flown("position=0.3,velocity=0.05,dropout=5%", seconds = 20).recorder.recording
    val errors    = errorsM(recording)
    val missing   = recording.events.count(event =>
      event.kind == EventKind.TimedOut && event.about.contains(EventSubject.Reading)
    )
    assert(errors.sizeIs > 1000, errors.size)
    assertEqualsDouble(sd(errors), 0.3, 0.02)
    assertEqualsDouble(missing.toDouble / (missing + recording.readings.size), 0.05, 0.025)
    assertEquals(recording.heading.parameter("sensors"), Some("position=0.3,velocity=0.05,dropout=5%"))
    assertEquals(recording.truths.map(_.vehicle).toSet, recording.heading.vehicles.map(_.name).toSet)

  test("a reading without data of the sensors is no loss of the link"):
    val traces = RoundTripTrace.of(flown("dropout=20%", seconds = 8).recorder.recording)
    assert(traces.forall(_.size > 30), traces.map(_.size))
    assertEquals(traces.map(_.lost.count(identity)), Vector(0, 0))

  test("equal seeds give equal flights, and the errors matter"):
    def digest(sensors: String) = flown(sensors, seconds = 4).recorder.digest
    val noisy                   = "position=0.1,drift=1/10s,outage=1s/3s"
    assertEquals(digest(noisy), digest(noisy))
    assertNotEquals(digest(noisy), digest("position=0.1,drift=1/10s"))

  test("every loop flies through outages of sensors to its end"):
    for loop <- LoopKind.values if loop != LoopKind.Plan do
      val result = flown("velocity=0.05,outage=1s/4s", loop, seconds = 8)
      assertEquals(result.landed.outcome, FlightOutcome.Completed, loop.label)

  test("the recorded truth ends with the flight, before its vehicles brake"):
    for loop <- Seq(LoopKind.Paused, LoopKind.Stream) do
      val recording = flown("position=0.1", loop, seconds = 4).recorder.recording
      val begun     = recording.readings.map(_.state.validAt).min
      val lastS     = recording.truths.map(_.validAt).max.since(begun).toSeconds
      assert(lastS > 3.8 && lastS <= 4, s"${loop.label}: $lastS s")

  test("over MAVLink readings have the stated errors, too"):
    val recording = flown("position=0.5,outage=1s/5s", LoopKind.Stream, 20, Wire.Mavlink).recorder.recording
    assertEqualsDouble(sd(errorsM(recording)), 0.5, 0.05)
