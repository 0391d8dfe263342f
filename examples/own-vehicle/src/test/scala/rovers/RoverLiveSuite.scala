package rovers

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.flight.Replayed
import skein.loop.{LoopKind, FlightOutcome}
import skein.record.{DuckDbRecorder, RecordingReader}
import skein.testing.TemporaryFolders
import skein.units.*

/** Drives over TCP on loopback, in real time, recorded on disk. */
class RoverLiveSuite extends munit.FunSuite, TemporaryFolders:
  import Program.scenarios
  private given system: ActorSystem = ActorSystem("rovers")
  override def afterAll(): Unit     = { val _ = Await.result(system.terminate(), 10.seconds) }

  for loop <- Seq(LoopKind.Stream, LoopKind.Plan) do
    test(s"${loop.label}: the robots drive over TCP, and all decisions are repeated from the recording"):
      import system.dispatcher
      val file   = temporaryFolder().resolve("live.duckdb")
      val landed = Chase.live(loop, Span.ofSeconds(4)): flight =>
        DuckDbRecorder.open(file, flight.heading).map(_.fold(error => fail(error.message), identity))
      assertEquals(Await.result(landed, 60.seconds).outcome, FlightOutcome.Completed)
      val recording = RecordingReader.read(file).fold(error => fail(error.message), identity)
      val driven    = recording.readings.filter(_.vehicle == "Hound").map(_.state.value.positionNed)
      assert(driven.head.horizontalDistance(driven.last) > 2, driven.last.toString)
      assert(recording.decisions.size > 10, s"${recording.decisions.size} decisions")
      assertEquals(recording.planned.nonEmpty, loop == LoopKind.Plan)
      assertEquals(Replayed.of(file).map(_.decidedAgain), Right(None))
