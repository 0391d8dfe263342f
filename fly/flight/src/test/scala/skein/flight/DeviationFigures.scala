package skein.flight

import skein.loop.LoopKind
import skein.measure.{DistanceCurve, RecordedTracks}
import skein.record.Recording
import skein.settings.*
import skein.signal.LatencyProfile
import skein.scenario.Scenarios
import skein.units.*

/** Prints the effect on the paper's duel if vehicle and air differ from the model: for each predictor the
  * mean distance over the last 10 s, that of the paused flight, and the errors of predictions after 10 s.
  *
  * {{{
  * ./sbtw "flight/Test/runMain skein.flight.deviationFigures 4 airsim airsim:wind=8/0/0"
  * }}}
  */
@main def deviationFigures(seeds: Int, plants: String*): Unit =
  given Scenarios = Scenarios.ours
  for plant <- plants do
    def settings(seed: Long, predictor: String) = FlySettings(
      List(LoopKind.Paused, LoopKind.Predictive),
      List(LatencyProfile.vpn),
      Span.ofSeconds(60),
      Span.ofMillis(100),
      seed,
      plant = SimulatedBody.parse(plant).fold(sys.error, identity),
      predictor = PredictionModel.parse(predictor).fold(sys.error, identity)
    )
    def flown(of: FlySettings, plan: FlightPlan) =
      VirtualFlights.fly(of, plan).fold(sys.error, identity).recorder.recording
    def distanceM(recording: Recording) =
      val tracks = RecordedTracks.of(recording)
      DistanceCurve.between(tracks(0), tracks(1)).flatMap(_.lastTenSeconds).get.mean
    for predictor <- Seq("quadrotor", "adaptive", "constant-velocity") do
      val results =
        for seed <- 1L to seeds yield
          val of        = settings(10 * seed, predictor)
          val truth     = distanceM(flown(of, of.plans.head))
          val recording = flown(of, of.plans.last.copy(seed = of.plans.head.seed))
          val since     = recording.predictions.head.madeAt + Span.ofSeconds(10)
          val errors    = recording.predictions.filter(_.madeAt > since).map(_.error.value).sorted
          (truth, distanceM(recording), errors(errors.size / 2), errors(errors.size * 95 / 100))
      def mean(of: ((Double, Double, Double, Double)) => Double) = results.map(of).sum / results.size
      println(
        f"$plant%-44s $predictor%-18s truth ${mean(_._1)}%6.3f m, predictive ${mean(_._2)}%6.3f m " +
          f"(${100 * (mean(_._2) / mean(_._1) - 1)}%+5.2f %%), error median ${1000 * mean(_._3)}%6.1f mm, " +
          f"95 %% ${1000 * mean(_._4)}%6.1f mm"
      )
