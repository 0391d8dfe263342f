package skein.record

import java.io.IOException
import java.nio.file.{FileSystemException, Path}
import java.util.Locale

/** Converts an exception of a file to a reason that a person understands. */
private[skein] object FileReason:
  /** Runs an action on files; its exception becomes an error with the reason. */
  def attempt[A, E](error: String => E)(action: => A): Either[E, A] =
    try Right(action)
    catch case failed: IOException => Left(error(of(failed)))

  /** The reason without names of Java's classes. */
  def of(failed: IOException): String = failed match
    case failed: FileSystemException =>
      val what = Option(failed.getReason).getOrElse:
        failed.getClass.getSimpleName
          .stripSuffix("Exception")
          .replaceAll("(?<=.)([A-Z])", " $1")
          .toLowerCase(Locale.ROOT)
      // Files made only to test for write access are not named.
      Option(failed.getFile).filterNot(file => Path.of(file).getFileName.toString.startsWith(".skein"))
        .fold(what)(file => s"$what ($file)")
    case other => other.getMessage
