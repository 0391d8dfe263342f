package rovers

import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.loop.LoopKind
import skein.record.DuckDbRecorder
import skein.report.{Report, ReportSections}
import skein.units.*

/** Drives for 30 s over TCP, then in virtual time; writes both recordings and a report of them. */
@main def driveRovers(): Unit =
  given system: ActorSystem = ActorSystem("rovers")
  import Program.scenarios
  import system.dispatcher
  val folder       = Files.createTempDirectory("rovers")
  val (live, twin) = (folder.resolve("live.duckdb"), folder.resolve("virtual.duckdb"))
  val duration     = Span.ofSeconds(30)
  println("driving for 30 s over TCP")
  val landed = Chase.live(LoopKind.Stream, duration): flight =>
    DuckDbRecorder.open(live, flight.heading).map(_.fold(error => sys.error(error.message), identity))
  println(s"ended: ${Await.result(landed, 1.minute).outcome}")
  val written = Chase.virtual(LoopKind.Stream, duration, seed = 1).writeTo(twin)
  for
    _      <- written.left.map(_.message)
    set    <- Report.read(Seq(live, twin)).left.map(_.map(_.message).mkString("\n"))
    report <- Report.write(set, folder)
  do
    println(ReportSections.text(set))
    println(s"report in ${report.page}; trajectories in ${Path.of("figures").resolve("trajectories.svg")}")
  system.terminate(): Unit
