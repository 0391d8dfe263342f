package rovers

import java.nio.file.Files
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.loop.{LoopKind, FlightOutcome, Replay}
import skein.record.{DuckDbRecorder, RecordingReader}
import skein.units.*

/** Over TCP on loopback, in real time, recorded on disk. */
class RoverLiveSuite extends munit.FunSuite:
  private given system: ActorSystem = ActorSystem("rovers")
  override def afterAll(): Unit     = { val _ = Await.result(system.terminate(), 10.seconds) }

  test("the robots drive over TCP; what was decided is decided again from the recording"):
    import system.dispatcher
    val file   = Files.createTempDirectory("rovers").resolve("live.duckdb")
    val landed = Chase.live(LoopKind.Stream, Span.ofSeconds(4)): flight =>
      DuckDbRecorder.open(file, flight.heading).map(_.fold(error => fail(error.message), identity))
    assertEquals(Await.result(landed, 60.seconds).outcome, FlightOutcome.Completed)
    val recording = RecordingReader.read(file).fold(error => fail(error.message), identity)
    val driven    = recording.readings.filter(_.vehicle == "Hound").map(_.state.value.positionNed)
    assert(driven.head.horizontalDistance(driven.last) > 2, driven.last.toString)
    assert(recording.decisions.size > 10, s"${recording.decisions.size} decisions")
    assertEquals(Replay(Rovers().fleet, recording).firstDifference, None)
