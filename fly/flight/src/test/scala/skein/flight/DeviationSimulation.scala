package skein.flight

import skein.loop.LoopKind
import skein.record.Recording
import skein.scenario.Scenarios
import skein.settings.*
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

/** Flights of vehicles, and in air, that differ from the model. */
class DeviationSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = Scenarios.ours

  private val All = "airsim:mass=1.3,drag=2,lag=1.5,wind=8/0/0"

  private def flown(plant: String, predictor: PredictionModel, seconds: Double = 30): VirtualFlightResult =
    val settings = FlySettings(
      List(LoopKind.Predictive),
      List(LatencyProfile.vpn),
      Span.ofSeconds(seconds),
      Span.ofMillis(100),
      seed = 3,
      plant = SimulatedBody.parse(plant).fold(fail(_), identity),
      predictor = predictor
    )
    VirtualFlights.fly(settings, settings.plans.head).fold(fail(_), identity)

  /** The 95th percentile of the errors of predictions that were made after the first 10 s, m. */
  private def errorM(recording: Recording): Double =
    val all    = recording.predictions
    val learnt = all.filter(_.madeAt.since(all.head.madeAt) > Span.ofSeconds(10)).map(_.error.value).sorted
    assert(learnt.sizeIs > 300, learnt.size)
    learnt(learnt.size * 95 / 100)

  test(
    "in wind, adaptive predicts a heavier, slower vehicle with more drag five times better after 10 s"
  ):
    val fixed    = errorM(flown(All, PredictionModel.Quadrotor).recorder.recording)
    val adaptive = errorM(flown(All, PredictionModel.Adaptive).recorder.recording)
    assert(fixed > 0.01, fixed)
    assert(adaptive < fixed / 5, s"$adaptive m against $fixed m")

  test("if the model is right, the adaptive one is as good"):
    val fixed    = errorM(flown("airsim", PredictionModel.Quadrotor).recorder.recording)
    val adaptive = errorM(flown("airsim", PredictionModel.Adaptive).recorder.recording)
    assert(adaptive < 1.1 * fixed, s"$adaptive m against $fixed m")

  test("gusts depend on the flight's seed, and differ between vehicles"):
    def digest() = flown("airsim:gusts=15", PredictionModel.Quadrotor, 4).recorder.digest
    assertEquals(digest(), digest())
    assertNotEquals(digest(), flown("airsim", PredictionModel.Quadrotor, 4).recorder.digest)

  test("a mistake in a deviation is one line, and external autopilots are refused"):
    assertEquals(
      SimulatedBody.parse("airsim:mass=9").map(_.text),
      Left("expected a number from 0.5 to 1.6, got 'mass=9'")
    )
    assert(SimulatedBody.parse("airsim:mass=1.1").toOption.flatMap(_.refusesAutopilots).isDefined)
    for name <- Seq("quadrotor:mass=1.3,lag=1.5", "tilt:drag=2") do
      assertEquals(VehicleChoice.parse(name, 20).map(_.name), Right(name))
    assertEquals(
      VehicleChoice.parse("tilt:wind=8/0/0", 20).map(_.name),
      Left(
        "expected mass, drag and lag; wind, gusts, shear and rotors are for fly and spread, " +
          "got 'tilt:wind=8/0/0'"
      )
    )
