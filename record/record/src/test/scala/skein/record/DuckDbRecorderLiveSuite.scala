package skein.record

import java.nio.{ByteBuffer, ByteOrder}
import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.util.Using
import scala.util.chaining.scalaUtilChainingOps
import skein.testing.{TemporaryFolders, Unhurried}

/** Needs threads: a database writes while others offer records. */
class DuckDbRecorderLiveSuite extends munit.FunSuite, Unhurried, TemporaryFolders:
  private given system: ActorSystem = ActorSystem("DuckDbRecorderLiveSuite")
  override def afterAll(): Unit     = { val _ = Await.result(system.terminate(), 10.seconds) }

  private def open(file: Path, capacity: Int): DuckDbRecorder =
    Await.result(
      DuckDbRecorder.open(file, Samples.heading, capacity),
      30.seconds
    ).fold(e => fail(e.message), identity)

  private def read(file: Path): Recording = RecordingReader.read(file).fold(e => fail(e.message), identity)

  folder.test("records offered before close are in the file, and the summary counts them"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val recorder = open(file, capacity = 1024)
    Samples.oneOfEach.foreach(recorder.offer)
    val written = Await.result(recorder.close(), 10.seconds)
    assertEquals(written.map(_.total), Right(Samples.heading.records.size + Samples.oneOfEach.size.toLong))
    assertEquals(Await.result(recorder.close(), 1.second), written)
    assert(!recorder.failure.isCompleted)
    assertEquals(read(file), Recording(Samples.heading, Samples.oneOfEach))

  folder.test("a recording has the file format of DuckDB 1.0, which later clients read, too"): folder =>
    val file = folder.resolve("flight.duckdb")
    Await.result(open(file, capacity = 16).close(), 10.seconds): Unit
    val version = ByteBuffer.wrap(Files.readAllBytes(file)).order(ByteOrder.LITTLE_ENDIAN).getLong(12)
    assertEquals(version, 64L)

  folder.test("many rows in many batches are all in the file, once and in order"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val recorder = open(file, capacity = 65536)
    val offered  = 3 * DuckDbRecorder.batchSize + 1
    for sequence <- 1 to offered do recorder.offer(Samples.reading(sequence))
    assertEquals(Await.result(recorder.close(), 60.seconds).map(_.rows("reading")), Right(offered.toLong))
    assertEquals(read(file).readings.map(_.sequence), Vector.range(1L, offered + 1L))

  folder.test("records beyond the queue's bound fail the recording, and the queued ones are written"):
    folder =>
      val file     = folder.resolve("flight.duckdb")
      val recorder = open(file, capacity = 16)
      val offered  = 100_000
      for sequence <- 1 to offered do recorder.offer(Samples.reading(sequence))
      assertEquals(Await.result(recorder.failure, 10.seconds), RecordError.QueueFull(16))
      val ending = Ending(Samples.at(1), EndingKind.Failed, Some(RecordError.QueueFull(16).message))
      recorder.offer(ending)
      assertEquals(Await.result(recorder.close(), 10.seconds), Left(RecordError.QueueFull(16)))
      assertEquals(read(file).ending, Some(ending), "how it ended is told in spite of that")
      val sequences = read(file).readings.map(_.sequence)
      assert(sequences.nonEmpty && sequences.size < offered)
      assertEquals(sequences, Vector.range(1L, sequences.size + 1L))

  folder.test(
    "rows that the database refuses fail the recording during the flight, and at its end"
  ): folder =>
    val file     = folder.resolve("flight.duckdb")
    val recorder = open(file, capacity = 1024)
    Using.resource(RecordingFile.connect(file, readOnly = false)): beside =>
      val _ = beside.createStatement().execute("DROP TABLE reading")
    recorder.offer(Samples.reading(1))
    val failed = Await.result(recorder.failure, 10.seconds)
    failed match
      case RecordError.WriteFailed(`file`, why) => assert(why.contains("reading"), why)
      case other                                => fail(s"expected WriteFailed, got $other")
    assertEquals(Await.result(recorder.close(), 10.seconds), Left(failed))

  folder.test("no commit waits for the disk"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val recorder = open(file, capacity = 1024)
    Using.resource(RecordingFile.connect(file, readOnly = false)): beside =>
      val mode = beside.createStatement().executeQuery("SELECT current_setting('fsync_mode')")
      assert(mode.next())
      assertEquals(mode.getString(1), "NONE")
    assert(Await.result(recorder.close(), 10.seconds).isRight)

  folder.test("a deleted file fails the recording immediately, not only at its end"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val recorder = open(file, capacity = 1024)
    recorder.offer(Samples.reading(1))
    Files.delete(file)
    recorder.offer(Samples.reading(2))
    val failed = RecordError.WriteFailed(file, "it was taken away while it was written")
    assertEquals(Await.result(recorder.failure, 10.seconds), failed)
    assertEquals(Await.result(recorder.close(), 10.seconds), Left(failed))

  folder.test(
    "a path that the driver would interpret as settings is refused, for writing and reading"
  ): folder =>
    val file = Files.createDirectory(folder.resolve("a;access_mode=READ_ONLY")).resolve("flight.duckdb")
    val made = Await.result(DuckDbRecorder.open(file, Samples.heading), 30.seconds).left.map(_.message)
    assert(clue(made).left.exists(_.contains("expected a path without ';'")))
    open(
      folder.resolve("flight.duckdb"),
      16
    ).close().map(_ => ())(using system.dispatcher).pipe(Await.result(_, 10.seconds))
    Files.move(folder.resolve("flight.duckdb"), file)
    assert(clue(RecordingReader.read(file)).left.exists(_.message.contains("expected a path without ';'")))

  folder.test("a recording is complete even if its actor system ends before it is closed"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val early    = ActorSystem("early")
    val opened   = Await.result(DuckDbRecorder.open(file, Samples.heading)(using early), 30.seconds)
    val recorder = opened.fold(error => fail(error.message), identity)
    val _        = Await.result(early.terminate(), 10.seconds)
    assert(Await.result(recorder.close(), 10.seconds).isRight)
    assert(RecordingReader.read(file).isRight)
