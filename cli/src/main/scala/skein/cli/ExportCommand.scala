package skein.cli

import java.nio.file.Path
import mainargs.{Leftover, ParserForClass, arg}
import skein.record.Export

/** Options of `./skein export`. */
final case class ExportOptions(
    @arg(doc = "one recording")
    file: Leftover[String],
    @arg(doc = "folder for one Parquet file per table")
    parquet: String
)

object ExportCommand
    extends OptionsCommand[ExportOptions](
      "export",
      "writes a recording's tables for other programs",
      ParserForClass[ExportOptions]
    ):

  protected def execute(options: ExportOptions): Either[String, Unit] =
    for
      file <- options.file.value match
        case Seq(one) => Right(Path.of(one))
        case others => Left(s"expected one recording, came ${others.size}: ./skein export FILE --parquet DIR")
      folder <- OutFolder.made("--parquet", options.parquet)
      files  <- Export.parquet(file, folder).left.map(_.message)
    yield Console.out.println(s"${files.size} tables in ${options.parquet}")
