package skein.cli

import java.nio.file.Path
import mainargs.{Flag, Leftover, ParserForClass, arg}
import skein.report.{Report, ReportSections}
import skein.scenario.Scenarios

/** Command-line options of `./skein report`, with their help texts. */
final case class ReportOptions(
    @arg(doc = "recordings, for example flights/*.duckdb")
    files: Leftover[String],
    @arg(doc = "folder for the report; without it, the folder of the first recording")
    out: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

/** `./skein report`: makes tables and figures from recordings only. */
final class ReportCommand(using Scenarios)
    extends Command[ReportOptions](
      "report",
      "rebuilds tables and pictures from recordings alone",
      ParserForClass[ReportOptions]
    ):

  protected def execute(options: ReportOptions): Either[String, Unit] =
    val files = options.files.value.map(Path.of(_))
    for
      first <- files.headOption.toRight("expected recordings, got none: ./skein report FILE…")
      read  <- Report.readOnce(files).left.map(_.map(_.message).mkString("\n"))
      set = read.flights
      out    <- OutFolder.made("--out", options.out.getOrElse(OutFolder.of(first)))
      output <- Report.write(set, out, files)
      shown = Shown(options.json.value)
      _     = read.twice.foreach(shown.say)
      _     = shown.tables(ReportSections.of(set), ReportSections.text(set))
      _     = output.withoutPng.foreach(reason => shown.say(s"\nno PNG files: $reason"))
      _     = output.told.foreach(shown.say)
      _ <- output.whole
    yield ()
