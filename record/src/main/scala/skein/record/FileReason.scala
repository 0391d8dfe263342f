package skein.record

import java.io.IOException
import java.nio.file.FileSystemException
import java.util.Locale

/** Why a file could not be read or written, for a person. */
private[skein] object FileReason:
  /** Without the names of Java's classes. */
  def of(failed: IOException): String = failed match
    case failed: FileSystemException =>
      val what = Option(failed.getReason).getOrElse:
        failed.getClass.getSimpleName
          .stripSuffix("Exception")
          .replaceAll("(?<=.)([A-Z])", " $1")
          .toLowerCase(Locale.ROOT)
      s"$what (${failed.getFile})"
    case other => other.getMessage
