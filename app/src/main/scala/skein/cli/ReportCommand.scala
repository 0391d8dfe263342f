package skein.cli

import java.nio.file.Path
import mainargs.{Leftover, ParserForClass, arg}
import skein.report.{Report, SummaryTables}

/** Options of `./skein report`. */
final case class ReportOptions(
    @arg(doc = "recordings, for example flights/*.duckdb")
    files: Leftover[String],
    @arg(doc = "folder for the report; without it, the folder of the first recording")
    out: Option[String]
)

object ReportCommand
    extends OptionsCommand[ReportOptions](
      "report",
      "rebuilds tables and pictures from recordings alone",
      ParserForClass[ReportOptions]
    ):

  protected def execute(options: ReportOptions): Either[String, Unit] =
    val files = options.files.value.map(Path.of(_))
    for
      first <- files.headOption.toRight("expected recordings, came none: ./skein report FILE…")
      out = options.out.fold(first.toAbsolutePath.getParent)(Path.of(_))
      set    <- Report.read(files).left.map(_.map(_.message).mkString("\n"))
      output <- Report.write(set, out)
    yield
      Console.out.println(SummaryTables.text(set))
      output.withoutPng.foreach(reason => Console.out.println(s"\nno PNG files: $reason"))
      Console.out.println(s"\nreport in ${output.page}")
