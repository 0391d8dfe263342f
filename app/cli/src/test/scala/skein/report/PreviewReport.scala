package skein.report

import java.nio.file.Path
import skein.scenario.Scenarios

/** Writes a report of seven synthetic flights like the experiment's into a folder, to inspect pictures during
  * development. `./sbtw "cli/Test/runMain skein.report.PreviewReport FOLDER"`
  */
object PreviewReport:
  private given Scenarios = PaperReport.scenarios

  def main(arguments: Array[String]): Unit =
    val flown = Vector("paused" -> "none") ++
      (for link <- Seq("direct", "vpn"); loop <- Seq("sequential", "futures", "stream") yield loop -> link)
    val set = Report.of(flown.zipWithIndex.map { case ((loop, link), seed) =>
      SyntheticFlight(loop, link, seed)
    })
    println(ReportSections.text(set))
    println(Report.write(set, Path.of(arguments(0))).fold(identity, _.page))
