package skein.settings

import java.io.IOException
import java.nio.ByteBuffer
import java.nio.charset.CharacterCodingException
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.{AccessDeniedException, Files, Path}
import scala.util.Using

/** Reads text files that users name on the command line. */
object TextFile:
  private val MostBytes = 64 << 20

  /** Says in an error where a relative path was sought: not in a configuration's or a recorded flight's
    * folder.
    */
  private def sought(file: Path): String =
    if file.isAbsolute then "" else s", sought from ${Path.of("").toAbsolutePath}"

  /** The file's text, or why it cannot be read. */
  def read(path: String): Either[String, String] =
    val file = Path.of(path)
    if path.isEmpty then Left("expected the name of a file, got ''")
    else if !Files.exists(file) then Left(s"there is no file $path${sought(file)}")
    else if Files.isDirectory(file) then Left(s"expected a file, got the folder $path")
    else
      try
        val bytes = Using.resource(Files.newInputStream(file))(_.readNBytes(MostBytes + 1))
        Either.cond(
          bytes.length <= MostBytes,
          // Some editors begin a text with a mark of its byte order, which is not part of it.
          UTF_8.newDecoder().decode(ByteBuffer.wrap(bytes)).toString.stripPrefix("\ufeff"),
          s"expected a file of at most ${MostBytes >> 20} MiB, got $path, which is larger"
        )
      catch
        case _: CharacterCodingException => Left(s"$path is no text in UTF-8")
        case _: AccessDeniedException    => Left(s"cannot read $path: access denied")
        case error: IOException          => Left(s"cannot read $path: ${error.getMessage}")
