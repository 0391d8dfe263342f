package skein.flight

import java.nio.file.Files
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.link.{MemoryNetwork, NetworkPlan}
import skein.loop.planning.CountedPlanWorkers
import skein.loop.{LoopKind, FlightOutcome, PlanSettings}
import skein.measure.FlightSummary
import skein.record.*
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.{Optimised, TemporaryFolders}
import skein.units.*
import skein.vtime.VirtualTime

/** Flights that are paused after a while and continued 5 s later, in virtual time. */
class HeldFlightSimulation extends munit.FunSuite, TemporaryFolders, Optimised:
  private given Scenarios = Scenarios.ours

  private val settings = FlySettings(
    LoopKind.values.toList,
    List(LatencyProfile.vpn),
    duration = Span.ofSeconds(12),
    period = Span.ofMillis(100),
    seed = 5,
    planning = PlanSettings(horizonSteps = 10, slices = 2, blocksPerSlice = 1)
  )

  /** Runs a paused flight.
    *
    * @param stopping whether it is stopped instead of continued
    */
  private def fly(loop: LoopKind, stopping: Boolean = false): (FlightOutcome, MemoryRecorder) =
    val plan = settings.plans.find(_.loop == loop).getOrElse(fail("there is no such flight"))
    VirtualTime
      .run(plan.seed): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock     = Clock.ofNanos(VirtualTime.clock(system))
        val host      = MemoryNetwork(NetworkPlan(), plan.seed, clock).host("localhost")
        val assembler = FlightAssembler(
          host,
          clock,
          settings,
          simulator = None,
          workers = planning => CountedPlanWorkers(planning.searches, planning.slices)
        )
        val recorder = MemoryRecorder(assembler.heading(plan, clockKind = "real"))
        assembler
          .start(plan, recorder)
          .flatMap:
            case Left(reason)    => Future.failed(IllegalStateException(reason))
            case Right(assembly) =>
              def after(span: Span)(act: => Unit) =
                system.scheduler.scheduleOnce(span.toDuration)(act): Unit
              def pause() =
                assembly.pause("by the test")
                assembly.pause("again, which is nothing new")
              // The paused loop waits for nothing but the simulator, and ends immediately.
              val at = Span.ofSeconds(if loop == LoopKind.Paused then 0 else 3)
              if loop == LoopKind.Paused then pause() else after(at)(pause())
              after(at + Span.ofSeconds(5))(if stopping then assembly.stop("by the test")
              else assembly.continue("by the test"))
              assembly.landed.map(landed => (landed.outcome, recorder))
      .value

  for loop <- LoopKind.values do
    test(
      s"${loop.label}: a paused flight makes no decisions and its vehicles hover; then it continues"
    ):
      val (outcome, recorder) = fly(loop)
      val recording           = recorder.recording
      assertEquals(outcome, FlightOutcome.Completed)
      val turns = recording.events.filter(event => Set(EventKind.Paused, EventKind.Continued)(event.kind))
      assertEquals(
        turns.map(event => (event.kind, event.detail)),
        Vector(EventKind.Paused -> "by the test", EventKind.Continued -> "by the test")
      )
      val Vector(from, to) = turns.map(_.at): @unchecked
      // Decisions of the paused loop bear the simulator's time, which stands still.
      val sent    = recording.commands.map(_.sentAt)
      val settled = from + Span.ofMillis(500)
      assertEquals(sent.count(at => at > settled && at < to), 0)
      assert(sent.count(_ >= to) > 20, sent.size.toString)
      if loop != LoopKind.Paused then
        assert(sent.count(_ < from) > 10, sent.size.toString)
        assertEquals(recording.decisions.count(made => made.decidedAt > settled && made.decidedAt < to), 0)
        for made <- recording.decisions if made.decidedAt > to do
          assert(
            made.observations.ownAge < Span.ofMillis(400),
            s"decision ${made.sequence} at ${made.decidedAt.since(to)}"
          )
        // To hover is to hold the position at which the command arrived: a fast vehicle returns to it.
        for name <- recording.heading.vehicles.map(_.name) do
          val held = recording.readings
            .filter(read => read.vehicle == name && read.state.receivedAt > from + Span.ofMillis(200))
            .map(_.state)
            .takeWhile(_.receivedAt < to)
          val moved = held.map(_.value.positionNed.horizontalDistance(held.head.value.positionNed)).max
          assert(held.size > 10 && moved < 15, s"$name moved $moved m in ${held.size} readings")
          assert(held.last.value.velocityNed.norm < 2, s"$name: ${held.last.value.velocityNed}")
      assert(to.since(from) - Span.ofSeconds(5) < Span.ofMillis(1))
      assertEquals(FlightSummary.of(recording).paused.map(_.toSeconds.round), Some(5L))
      val file = temporaryFolder().resolve("flight.duckdb")
      try
        assert(recorder.writeTo(file).isRight)
        assertEquals(Replayed.of(file).map(_.decidedAgain), Right(None))
      finally
        Files.delete(file)
        Files.delete(file.getParent)

  for loop <- Seq(LoopKind.Paused, LoopKind.Stream, LoopKind.Predictive) do
    test(s"${loop.label}: a paused flight can be ended"):
      val (outcome, recorder) = fly(loop, stopping = true)
      assertEquals(outcome, FlightOutcome.Stopped)
      assertEquals(FlightSummary.of(recorder.recording).paused.map(_.toSeconds.round), Some(5L))
