package skein.cli

import java.nio.file.{Files, Path}
import mainargs.{Leftover, ParserForClass, arg}
import skein.record.{Export, McapRecording}
import skein.units.Expect

/** Command-line options of `./skein export`, with their help texts. */
final case class ExportOptions(
    @arg(doc = "one recording")
    file: Leftover[String],
    @arg(doc = "folder for one Parquet file per table")
    parquet: Option[String],
    @arg(doc = "MCAP file, for Foxglove, Lichtblick, PlotJuggler and Rerun; it is replaced")
    mcap: Option[String]
)

/** `./skein export`: writes a recording as Parquet or MCAP. */
object ExportCommand
    extends OptionsCommand[ExportOptions](
      "export",
      "writes a recording for other programs",
      ParserForClass[ExportOptions]
    ):
  private val usage = "./skein export FILE --parquet DIR, or --mcap FILE"

  protected def execute(options: ExportOptions): Either[String, Unit] =
    for
      file <- options.file.value match
        case Seq(one) => Right(Path.of(one))
        case others   => Left(s"expected one recording, came ${others.size}: $usage")
      _ <- Expect.that(options.parquet.nonEmpty || options.mcap.nonEmpty):
        s"expected what to write, came nothing: $usage"
      _ <- options.parquet.fold(Right(()))(parquet(file, _))
      _ <- options.mcap.fold(Right(()))(mcap(file, _))
    yield ()

  private def parquet(file: Path, text: String): Either[String, Unit] =
    for
      folder <- OutFolder.made("--parquet", text)
      files  <- Export.parquet(file, folder).left.map(_.message)
    yield Console.out.println(s"${files.size} tables in $text")

  private def isSame(one: Path, other: Path) =
    Files.exists(one) && Files.exists(other) && Files.isSameFile(one, other)

  private def mcap(file: Path, text: String): Either[String, Unit] =
    for
      _ <- OutFolder.isThere("--mcap", text)
      _ <- Expect.that(!isSame(file, Path.of(text))):
        s"--mcap: expected another file than the recording, came $text"
      _ <- McapRecording.write(file, Path.of(text), RecordOptions.sceneOf).left.map(_.message)
    yield Console.out.println(s"recording in $text")
