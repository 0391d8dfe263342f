package skein.cli

import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}
import scala.util.Using
import skein.record.{EventKind, CameraImage, RecordingReader}
import skein.report.PaperReport
import skein.scenario.Scenarios

/** One flight of two vehicles, repeated in turns: without images; with four cameras at 30 Hz in the
  * recording; and with an additional MCAP file: `cli/Test/runMain skein.cli.filmedFlights stream 20 3`.
  * Prints the delay of control's requests, and the processor time of the whole process, including simulator
  * and rendering.
  */
@main def filmedFlights(loop: String, seconds: Int, rounds: Int): Unit =
  given Scenarios = PaperReport.scenarios
  val folder      = Files.createTempDirectory("filmed")
  val cameras     = Seq("--images", "front_center@30", "--images", "bottom_center@30")
  val kinds       = Seq(
    "no images"           -> Nil,
    "images"              -> cameras,
    "images, MCAP beside" -> (cameras ++ Seq("--record", "mcap"))
  )
  val cpu = ManagementFactory.getOperatingSystemMXBean.asInstanceOf[com.sun.management.OperatingSystemMXBean]
  try
    for round <- 1 to rounds; ((what, options), number) <- kinds.zipWithIndex do
      val out   = folder.resolve(s"$round-$number")
      val fixed =
        Seq("--loop", loop, "--link", "none", "--duration", s"${seconds}s", "--scene", "street")
      val flying = ViewLiveSuite.Flying.start(out, fixed ++ options*)
      flying.awaitStart(s"$loop-none")
      val (from, began) = (cpu.getProcessCpuTime, System.nanoTime())
      flying.land()
      val spent  = (cpu.getProcessCpuTime - from).toDouble / (System.nanoTime() - began)
      val file   = out.resolve(s"$loop-none.duckdb")
      val late   = Lateness.of(file)
      val rows   = RecordingReader.records(file).fold(error => sys.error(error.message), identity).map(_._2)
      val images = rows.collect { case image: CameraImage => image }
      val lost   = rows.collect:
        case event: skein.record.Event
            if event.kind == EventKind.Dropped && event.detail.contains("not recorded") => event
      println(
        f"$what%-20s ${late.questions}%,d questions, late p50 " +
          f"${late.p50Ms}%.2f, p99 ${late.p99Ms}%.2f, most ${late.mostMs}%.2f " +
          f"ms; ${images.size.toDouble / seconds}%.0f images/s of " +
          f"${images.headOption.fold(0)(_.pixels.size)}%,d bytes, ${lost.size} " +
          f"not recorded; ${spent * 100}%.0f %% of one core; load ${load()}"
      )
  finally
    Using.resource(Files.walk(folder))(_.sorted(java.util.Comparator.reverseOrder()).forEach((path: Path) =>
      Files.delete(path)
    ))
