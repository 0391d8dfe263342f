package skein.loop

import java.nio.file.Path
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.{ExecutionContext, Future}
import skein.record.{MemoryRecorder, Recordable, RecordError, Recorder, Samples, Written}
import skein.scenario.PaperDuel
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime

/** The last answers of a flight are received after its time has elapsed: if they cannot be recorded, the
  * flight has failed.
  */
class LateFailureSimulation extends munit.FunSuite, Unhurried:

  /** The outcome of a flight of 2 s over 200 ms each way, whose recorder fails at a moment, if ever. */
  private def outcome(
      kind: LoopKind,
      failsAt: Option[Span],
      ends: () => FlightOutcome = () => FlightOutcome.Completed
  ) =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        val fleet              = PaperDuel().fleet
        val world              =
          FarQuadrotors(fleet, VirtualGame.constant(400), 1, clock)
        val kept     = MemoryRecorder(Samples.heading)
        val recorder = new Recorder:
          def offer(record: Recordable): Unit = kept.offer(record)
          val failure: Future[RecordError]    = failsAt.fold(Future.never): at =>
            after(at.toDuration, system.scheduler)(Future.successful(LateFailureSimulation.Full))
          def close(): Future[Either[RecordError, Written]] = kept.close()
        val team = Team(fleet, world.ports, clock, recorder, LoopSettings())
        Flight.start(kind, team, Some(world), Span.ofSeconds(2), clock, recorder, ends).outcome
      .value

  for kind <- Seq(LoopKind.Stream, LoopKind.Futures, LoopKind.Predictive) do
    test(s"${kind.label}: a recorder that fails while vehicles are commanded to hover fails the flight"):
      assertEquals(outcome(kind, None), FlightOutcome.Completed)
      assertEquals(
        outcome(kind, Some(Span.ofMillis(2100))),
        FlightOutcome.Failed(LateFailureSimulation.Full.message)
      )

  test("a flight that has already failed keeps its first reason"):
    val first = FlightOutcome.Failed("nobody answers")
    assertEquals(outcome(LoopKind.Stream, Some(Span.ofMillis(2100)), () => first), first)

object LateFailureSimulation:
  private val Full = RecordError.WriteFailed(Path.of("flight.duckdb"), "the disk is full")
