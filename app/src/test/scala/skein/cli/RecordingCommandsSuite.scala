package skein.cli

import java.io.{ByteArrayOutputStream, PrintStream}
import java.nio.file.{Files, Path}
import scala.util.Using
import skein.record.{MemoryRecorder, Recording}
import skein.report.SyntheticFlight

class RecordingCommandsSuite extends munit.FunSuite:
  private val recordings = FunFixture[Path](
    _ =>
      val folder = Files.createTempDirectory("flights")
      for (loop, link) <- Seq("paused" -> "none", "stream" -> "vpn") do
        write(SyntheticFlight(loop, link, seed = 1, seconds = 12), folder.resolve(s"$loop-$link.duckdb"))
      folder
    ,
    path =>
      Using.resource(Files.walk(path))(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
  )

  private def write(recording: Recording, file: Path): Unit =
    val recorder = MemoryRecorder(recording.heading)
    (recording.readings ++ recording.decisions ++ recording.commands).foreach(recorder.offer)
    assert(recorder.writeTo(file).isRight)

  /** Exit status, standard output and error output. */
  private def run(command: Command, arguments: String*): (Int, String, String) =
    val out    = ByteArrayOutputStream()
    val err    = ByteArrayOutputStream()
    val status = Console.withOut(PrintStream(out))(Console.withErr(PrintStream(err))(command.run(arguments)))
    (status, out.toString, err.toString)

  recordings.test("report rebuilds page and tables from the files alone"): folder =>
    val files = Seq("paused-none", "stream-vpn").map(name => folder.resolve(s"$name.duckdb").toString)
    val (status, text, err) = run(ReportCommand, files :+ "--out" :+ folder.resolve("report").toString*)
    assertEquals((status, err), (0, ""))
    assert(text.linesIterator.exists(line => line.startsWith("stream") && line.contains("vpn")), text)
    assert(Files.exists(folder.resolve("report/report.html")))

  recordings.test("report without --out writes beside the first recording"): folder =>
    assertEquals(run(ReportCommand, folder.resolve("stream-vpn.duckdb").toString)._1, 0)
    assert(Files.exists(folder.resolve("figures/distance.svg")))

  recordings.test("report names a file that is no recording, and writes nothing"): folder =>
    val text             = Files.writeString(folder.resolve("notes.txt"), "nothing")
    val (status, _, err) = run(ReportCommand, folder.resolve("stream-vpn.duckdb").toString, text.toString)
    assertEquals(status, 1)
    assert(err.contains(s"$text is not a recording"), err)
    assert(!Files.exists(folder.resolve("report.html")))

  recordings.test("export writes Parquet files of one recording"): folder =>
    val parquet = folder.resolve("parquet")
    assertEquals(
      run(ExportCommand, folder.resolve("stream-vpn.duckdb").toString, "--parquet", parquet.toString)._1,
      0
    )
    assert(Files.size(parquet.resolve("decision.parquet")) > 1000)

  recordings.test("export takes exactly one recording"): folder =>
    val (status, _, err) = run(ExportCommand, "--parquet", folder.toString)
    assertEquals(status, 1)
    assert(err.contains("expected one recording, came 0"), err)
