package skein.loop

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.ExecutionContext
import skein.loop.planning.CountedPlanWorkers
import skein.record.{MemoryRecorder, Prediction, Recording, Samples}
import skein.scenario.PaperDuel
import skein.signal.{LatencyDistribution, LatencyProfile}
import skein.units.*
import skein.vtime.VirtualTime

/** The paper's duel in virtual time, on [[FarQuadrotors]].
  *
  * @param distanceM horizontal distance between the vehicles' true positions: mean over the last 10 s of
  *   physics
  */
final case class VirtualDuel(distanceM: Double, outcome: FlightOutcome, recording: Recording):

  /** Prediction errors, ascending, m.
    *
    * @param own whether errors are of the deciding vehicle itself, or of its opponent
    */
  def predictionErrors(own: Boolean): Vector[Double] =
    recording.predictions
      .filter((prediction: Prediction) => (prediction.decider == prediction.vehicle) == own)
      .map(_.error.value)
      .sorted

object VirtualDuel:
  private val duration = Span.ofSeconds(60)
  private val measured = Span.ofSeconds(10)

  def fly(
      kind: LoopKind,
      link: LatencyProfile,
      seed: Long,
      settings: LoopSettings = LoopSettings(),
      slices: Int = LoopSettings().planning.slices
  ): VirtualDuel =
    var sum   = 0.0
    var steps = 0
    val run   = VirtualTime.run(seed): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val scenario           = PaperDuel().fleet
      val world              = FarQuadrotors(scenario, link, seed, clock)
      world.watch = (at, states) =>
        if at > duration - measured && at <= duration then
          sum += states(0).positionNed.horizontalDistance(states(1).positionNed)
          steps += 1
      val recorder = MemoryRecorder(Samples.heading)
      val workers  = CountedPlanWorkers(settings.planning.searches, slices)
      val team     = Team(scenario, world.ports, clock, recorder, settings, workers)
      Flight.start(kind, team, Some(world), duration, clock, recorder).outcome.map((_, recorder.recording))
    VirtualDuel(sum / steps, run.value._1, run.value._2)

  lazy val truth: VirtualDuel = fly(LoopKind.Paused, LatencyProfile.none, 1)

  /** A link that always takes half of `roundTripMs` each way. */
  def constant(roundTripMs: Double): LatencyProfile =
    LatencyProfile.Steady(
      s"constant:${roundTripMs}ms",
      LatencyDistribution.Constant(Span.ofMillis(roundTripMs))
    )
