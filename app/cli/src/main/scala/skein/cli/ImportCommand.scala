package skein.cli

import java.nio.file.Path
import mainargs.{Leftover, ParserForClass, arg}
import skein.record.{Digest, McapRecording}

/** Command-line options of `./skein import`, with their help texts. */
final case class ImportOptions(
    @arg(doc = "one MCAP file that ./skein export wrote")
    file: Leftover[String],
    @arg(doc = "the recording to make; it is not overwritten")
    recording: String
)

/** `./skein import`: converts an exported MCAP file back to a recording. */
object ImportCommand
    extends Command[ImportOptions](
      "import",
      "makes a recording from an exported MCAP file, with the same digest",
      ParserForClass[ImportOptions]
    ):

  protected def execute(options: ImportOptions): Either[String, Unit] =
    for
      file <- only(options.file, "MCAP file", "./skein import FILE --recording FILE").map(Path.of(_))
      _    <- OutFolder.isThere("--recording", options.recording)
      recording = Path.of(options.recording)
      _      <- McapRecording.read(file, recording).left.map(_.message)
      digest <- Digest.ofFile(recording).left.map(_.message)
    yield Console.out.println(s"$digest  ${options.recording}")
