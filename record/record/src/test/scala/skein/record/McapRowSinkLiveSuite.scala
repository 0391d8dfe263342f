package skein.record

import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.mcap.Parsed
import skein.mcap.Record.Message
import skein.mcap.file.McapFile
import skein.testing.{TemporaryFolders, Unhurried}

/** MCAP files that are written in parallel to a recording. */
class McapRowSinkLiveSuite extends munit.FunSuite, Unhurried, TemporaryFolders:
  private given system: ActorSystem = ActorSystem("McapRowSinkLiveSuite")
  override def afterAll(): Unit     = { val _ = Await.result(system.terminate(), 10.seconds) }

  private def recorded(file: Path, sinks: Vector[RowSink])(offer: DuckDbRecorder => Unit): Unit =
    val recorder = Await
      .result(DuckDbRecorder.open(file, Samples.heading, beside = sinks), 30.seconds)
      .fold(error => fail(error.message), identity)
    offer(recorder)
    assert(Await.result(recorder.close(), 30.seconds).isRight)

  private def sink(file: Path) =
    McapRowSink.open(file, Samples.heading).fold(error => fail(error.message), identity)

  folder.test("importing a file that was written in flight gives the recording's own digest"): folder =>
    val (file, mcap, again) =
      (folder.resolve("a.duckdb"), folder.resolve("a.mcap"), folder.resolve("b.duckdb"))
    val written = sink(mcap)
    recorded(file, Vector(written)): recorder =>
      for number <- 1L to 5000L do recorder.offer(Samples.reading(number))
      Samples.oneOfEach.foreach(recorder.offer)
    assertEquals(written.failure, None)
    assertEquals(McapRecording.read(mcap, again), Right(()))
    assertEquals(Digest.ofFile(again), Digest.ofFile(file))
    assertEquals(RecordingReader.records(again), RecordingReader.records(file))

  folder.test("rows can be read after a second of commits, even if the file was never finished"): folder =>
    val mcap    = folder.resolve("cut.mcap")
    val written = sink(mcap)
    written.put(Samples.heading.records.zipWithIndex.map((record, at) => (at.toLong, record)))
    for batch <- 1L to 40L do written.put(Seq((100 + batch, Samples.reading(batch))))
    val readings = McapFile.stream(mcap): records =>
      records.count:
        case Right(Parsed.Found(_: Message, _, _)) => true
        case _                                     => false
    assert(readings > 40, s"$readings messages")
    written.close()

  folder.test("a file that can no longer be written is reported, and the recording continues"): folder =>
    val (file, mcap) = (folder.resolve("a.duckdb"), folder.resolve("a.mcap"))
    val broken       = sink(mcap)
    broken.close()
    recorded(file, Vector(broken))(_.offer(Samples.reading(1)))
    assert(broken.failure.exists(_.startsWith(s"cannot write $mcap")), broken.failure.toString)
    assertEquals(RecordingReader.read(file).map(_.readings.size), Right(1))

  folder.test("an existing file is not overwritten"): folder =>
    val mcap = Files.writeString(folder.resolve("a.mcap"), "mine")
    assertEquals(McapRowSink.open(mcap, Samples.heading).left.toOption, Some(RecordError.AlreadyExists(mcap)))
    assertEquals(Files.readString(mcap), "mine")
