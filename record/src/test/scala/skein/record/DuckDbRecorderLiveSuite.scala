package skein.record

import java.io.{BufferedReader, InputStreamReader}
import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** Needs the real clock and processes of its own: what survives a kill is seen only in another process. */
class DuckDbRecorderLiveSuite extends munit.FunSuite:
  private given system: ActorSystem = ActorSystem("DuckDbRecorderLiveSuite")
  override def afterAll(): Unit     = { val _ = Await.result(system.terminate(), 10.seconds) }

  private val folder = FunFixture[Path](
    _ => Files.createTempDirectory("recording"),
    path =>
      Using.resource(Files.walk(path))(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
  )

  private def open(file: Path, capacity: Int): DuckDbRecorder =
    Await.result(
      DuckDbRecorder.open(file, Samples.heading, capacity),
      30.seconds
    ).fold(e => fail(e.message), identity)

  private def read(file: Path): Recording = RecordingReader.read(file).fold(e => fail(e.message), identity)

  /** Starts [[RecordUntilStopped]]; what the database unpacks goes into the file's folder. */
  private def child(file: Path): Process =
    val java    = Path.of(System.getProperty("java.home"), "bin", "java").toString
    val command = List(java, "--enable-native-access=ALL-UNNAMED", s"-Djava.io.tmpdir=${file.getParent}") ++
      List("-cp", System.getProperty("java.class.path"), "skein.record.RecordUntilStopped", file.toString)
    ProcessBuilder(command.asJava).redirectError(ProcessBuilder.Redirect.INHERIT).start()

  private def lines(process: Process): Iterator[String] =
    val reader = BufferedReader(InputStreamReader(process.getInputStream))
    Iterator.continually(reader.readLine()).takeWhile(_ != null)

  folder.test("what was offered before close is in the file, and the summary counts it"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val recorder = open(file, capacity = 1024)
    Samples.oneOfEach.foreach(recorder.offer)
    val written = Await.result(recorder.close(), 10.seconds)
    assertEquals(written.map(_.total), Right(Samples.heading.records.size + Samples.oneOfEach.size.toLong))
    assertEquals(Await.result(recorder.close(), 1.second), written)
    assert(!recorder.failure.isCompleted)
    assertEquals(read(file), Recording(Samples.heading, Samples.oneOfEach))

  folder.test("of many rows in many batches each is in the file, once and in its order"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val recorder = open(file, capacity = 65536)
    val offered  = 3 * DuckDbRecorder.batchSize + 1
    for sequence <- 1 to offered do recorder.offer(Samples.reading(sequence))
    assertEquals(Await.result(recorder.close(), 60.seconds).map(_.rows("reading")), Right(offered.toLong))
    assertEquals(read(file).readings.map(_.sequence), Vector.range(1L, offered + 1L))

  folder.test("records beyond the queue's bound fail the recording, and what was queued is written"):
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

  folder.test("an actor system that ends before the recording is closed fails the recording"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val early    = ActorSystem("early")
    val opened   = Await.result(DuckDbRecorder.open(file, Samples.heading)(using early), 30.seconds)
    val recorder = opened.fold(error => fail(error.message), identity)
    val _        = Await.result(early.terminate(), 10.seconds)
    Await.result(recorder.failure, 10.seconds) match
      case RecordError.WriteFailed(`file`, _) => ()
      case other                              => fail(s"expected WriteFailed, got $other")

  /** Kills a process that records into `file`, checks what is left, and tells how old the last row kept was, ms. */
  private def killed(file: Path): Double =
    val process  = child(file)
    val reported = lines(process)
    val last     = reported.map(_.toInt).dropWhile(_ < 1500).next()
    val killed   = skein.units.Clock.system.now()
    assert(process.toHandle.destroyForcibly())
    val offered = reported.foldLeft(last)((_, line) => line.toInt)
    val events  = read(file).events
    assertEquals(events.map(_.vehicle), Vector.tabulate(events.size)(number => Some(number.toString)))
    val lostMs = killed.since(events.last.at).toMillis
    println(f"kill -9: ${events.size} of ${offered + 1} rows kept, the last $lostMs%.0f ms old")
    lostMs

  folder.test("a kill -9 leaves a readable file without at most the last 200 ms"): folder =>
    // A busy disk may delay a commit; it does not do so each time.
    val lostMs = Iterator.range(0, 3).map(attempt => killed(folder.resolve(s"flight$attempt.duckdb")))
    assert(lostMs.exists(_ <= 200), "more than 200 ms were lost three times in a row")

  folder.test(
    "a disk that takes no more ends the recording with a clear error and leaves what was committed"
  ): folder =>
    val file     = folder.resolve("flight.duckdb")
    val process  = child(file)
    val reported = lines(process)
    val begin    = reported.take(200).toVector
    // A limit on the size of files meets the process as a full disk does: its writes are refused.
    val limit = List("prlimit", "--pid", process.pid.toString, "--fsize=1000000")
    assertEquals(ProcessBuilder(limit.asJava).inheritIO().start().waitFor(), 0)
    val all = begin ++ reported
    assertEquals(process.waitFor(), 0)
    println(s"full disk: ${all.last}")
    assert(all.last.startsWith(s"cannot write to recording $file: "), all.last)
    val events = read(file).events
    assert(events.nonEmpty && events.size < all.size, s"${events.size} of ${all.size} rows")
    assertEquals(events.map(_.vehicle), Vector.tabulate(events.size)(number => Some(number.toString)))
