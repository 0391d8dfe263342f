package skein.cli

import java.io.IOException
import java.nio.file.{FileSystemException, Files, Path}

/** Folders that commands write into. */
private[cli] object OutFolder:

  /** Makes the folder if need be and sees whether files can be written there, so that a command of minutes does not
    * fail at its end.
    *
    * @param option
    *   that names the folder, for example `--out`
    * @return
    *   or why not, in a line
    */
  def made(option: String, text: String): Either[String, Path] =
    if text.isEmpty then Left(s"$option: expected a folder, came ''")
    else
      val folder = Path.of(text)
      try
        Files.createDirectories(folder)
        Files.delete(Files.createTempFile(folder, ".skein", ""))
        Right(folder)
      catch
        case failed: FileSystemException =>
          Left(s"$option: cannot write into the folder $folder: ${reason(failed)}")
        case failed: IOException =>
          Left(s"$option: cannot write into the folder $folder: ${failed.getMessage}")

  private def reason(failed: FileSystemException): String =
    val what = Option(failed.getReason).getOrElse:
      failed.getClass.getSimpleName.stripSuffix("Exception").replaceAll("(?<=.)([A-Z])", " $1").toLowerCase(
        java.util.Locale.ROOT
      )
    s"$what (${failed.getFile})"
