package skein.cli

import java.nio.file.Path
import mainargs.{Leftover, ParserForClass, arg}
import skein.record.Digest
import skein.units.Expect

/** Command-line options of `./skein digest`, with their help texts. */
final case class DigestOptions(
    @arg(doc = "recordings, for example flights/*.duckdb")
    files: Leftover[String]
)

/** `./skein digest`: prints the SHA-256 of recordings' content. */
object DigestCommand
    extends Command[DigestOptions](
      "digest",
      "shows the SHA-256 of what recordings contain; equal flights have equal ones",
      ParserForClass[DigestOptions]
    ):

  protected def execute(options: DigestOptions): Either[String, Unit] =
    val files             = options.files.value
    val (unread, digests) =
      files.map(file => Digest.ofFile(Path.of(file)).map(digest => s"$digest  $file")).partitionMap(identity)
    digests.foreach(line => Console.out.println(line))
    for
      _ <- Expect.that(files.nonEmpty)("expected recordings, got none: ./skein digest FILE…")
      _ <- Expect.that(unread.isEmpty)(unread.map(_.message).mkString("\n"))
    yield ()
