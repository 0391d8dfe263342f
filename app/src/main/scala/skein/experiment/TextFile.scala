package skein.experiment

import java.io.IOException
import java.nio.file.{Files, Path}

/** Text files that users name. */
object TextFile:

  /** The file's text, or why it cannot be read. */
  def read(path: String): Either[String, String] =
    try Right(Files.readString(Path.of(path)))
    catch
      case error: IOException =>
        Left(s"cannot read $path: ${error.getClass.getSimpleName} ${error.getMessage}")
