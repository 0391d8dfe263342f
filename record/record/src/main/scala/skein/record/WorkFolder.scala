package skein.record

import java.io.{IOException, UncheckedIOException}
import java.nio.file.{Files, Path}
import java.util.Comparator
import scala.util.Using

/** A hidden folder for files that are not complete yet. */
private[record] object WorkFolder:

  /** Makes one in the folder of `file`, and deletes it after `use`, or when the process is terminated. */
  def beside[A](file: Path)(use: Path => A): A =
    val folder = Files.createTempDirectory(file.toAbsolutePath.getParent, ".skein")
    val hook   = Thread(() => delete(folder))
    try
      Runtime.getRuntime.addShutdownHook(hook)
      use(folder)
    finally
      try Runtime.getRuntime.removeShutdownHook(hook): Unit
      catch case _: IllegalStateException => () // The JVM is shutting down: the hook runs.
      delete(folder)

  /** As far as possible; again if another thread has added a file meanwhile. */
  private def delete(folder: Path): Unit =
    for _ <- 1 to 3 if Files.exists(folder) do
      try
        Using.resource(Files.walk(folder))(
          _.sorted(Comparator.reverseOrder()).forEach(one => Files.deleteIfExists(one): Unit)
        )
      catch case _: (IOException | UncheckedIOException) => ()
