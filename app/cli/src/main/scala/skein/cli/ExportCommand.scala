package skein.cli

import java.nio.file.{Files, Path}
import mainargs.{Leftover, ParserForClass, arg}
import skein.record.{Export, McapRecording}
import skein.rosbag.RosBag
import skein.units.Expect

/** Command-line options of `./skein export`, with their help texts. */
final case class ExportOptions(
    @arg(doc = "one recording")
    file: Leftover[String],
    @arg(doc = "folder for one Parquet file per table")
    parquet: Option[String],
    @arg(doc = "MCAP file, for Foxglove, Lichtblick, PlotJuggler and Rerun; it is replaced")
    mcap: Option[String],
    @arg(doc =
      "folder for a bag of ROS 2, for ros2 bag play: odometry, tf, commands, images and scans; it must not " +
        "be there yet"
    )
    rosbag: Option[String]
)

/** `./skein export`: writes a recording as Parquet, as MCAP, or as a bag of ROS 2. */
object ExportCommand
    extends Command[ExportOptions](
      "export",
      "writes a recording for other programs",
      ParserForClass[ExportOptions]
    ):
  private val usage = "./skein export FILE --parquet DIR, --mcap FILE, or --rosbag DIR"

  protected def execute(options: ExportOptions): Either[String, Unit] =
    for
      file <- only(options.file, "recording", usage).map(Path.of(_))
      _    <- Expect.that(Seq(options.parquet, options.mcap, options.rosbag).exists(_.nonEmpty)):
        s"expected what to write, got nothing: $usage"
      _ <- options.parquet.fold(Right(()))(parquet(file, _))
      _ <- options.mcap.fold(Right(()))(mcap(file, _))
      _ <- options.rosbag.fold(Right(()))(rosbag(file, _))
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
        s"--mcap: expected another file than the recording, got $text"
      _ <- McapRecording.write(file, Path.of(text), RecordOptions.sceneOf).left.map(_.message)
    yield Console.out.println(s"recording in $text")

  private def rosbag(file: Path, text: String): Either[String, Unit] =
    for
      _ <- OutFolder.isThere("--rosbag", text)
      _ <- Expect.that(Files.notExists(Path.of(text))):
        s"--rosbag: expected a folder that is not there yet, got $text"
      topics <- RosBag.write(file, Path.of(text))
    yield
      for (topic, count) <- topics do Console.out.println(s"$topic: $count messages")
      Console.out.println(s"bag in $text")
