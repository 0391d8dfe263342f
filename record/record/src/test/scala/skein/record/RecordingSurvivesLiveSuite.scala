package skein.record

import java.io.{BufferedReader, InputStreamReader}
import java.nio.file.Path
import scala.jdk.CollectionConverters.*
import skein.testing.{TemporaryFolders, Unhurried}

/** Needs the real clock and processes of its own: only another process can see what survives a kill. */
class RecordingSurvivesLiveSuite extends munit.FunSuite, TemporaryFolders, Unhurried:

  private def read(file: Path): Recording = RecordingReader.read(file).fold(e => fail(e.message), identity)

  /** Starts [[RecordUntilStopped]]; files that the database unpacks go into the file's folder. */
  private def child(file: Path): Process =
    val java    = Path.of(System.getProperty("java.home"), "bin", "java").toString
    val options = List("-XX:TieredStopAtLevel=1", "-XX:+UseSerialGC", "--enable-native-access=ALL-UNNAMED")
    val command = (java +: options :+ s"-Djava.io.tmpdir=${file.getParent}") ++
      List("-cp", System.getProperty("java.class.path"), "skein.record.RecordUntilStopped", file.toString)
    ProcessBuilder(command.asJava).redirectError(ProcessBuilder.Redirect.INHERIT).start()

  private def lines(process: Process): Iterator[String] =
    val reader = BufferedReader(InputStreamReader(process.getInputStream))
    Iterator.continually(reader.readLine()).takeWhile(_ != null)

  /** Kills a process that records into `file`, checks the remaining file, and returns the age of the last
    * row, ms.
    */
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

  folder.test("after a kill -9 the file is readable and lacks at most the last 200 ms"): folder =>
    // A busy disk may delay a commit, but not every time.
    val lostMs = Iterator.range(0, 3).map(attempt => killed(folder.resolve(s"flight$attempt.duckdb")))
    assert(lostMs.exists(_ <= 200), "more than 200 ms were lost three times in a row")

  folder.test("a full disk ends the recording with a clear error and leaves the committed rows"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val process  = child(file)
    val reported = lines(process)
    val begin    = reported.take(200).toVector
    // A limit on the size of files acts like a full disk: the process's writes are refused.
    val limit = List("prlimit", "--pid", process.pid.toString, "--fsize=1000000")
    assertEquals(ProcessBuilder(limit.asJava).inheritIO().start().waitFor(), 0)
    val all = begin ++ reported
    assertEquals(process.waitFor(), 0)
    println(s"full disk: ${all.last}")
    assert(all.last.startsWith(s"cannot write to recording $file: "), all.last)
    val events = read(file).events
    assert(events.nonEmpty && events.size < all.size, s"${events.size} of ${all.size} rows")
    assertEquals(events.map(_.vehicle), Vector.tabulate(events.size)(number => Some(number.toString)))
