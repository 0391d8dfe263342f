package skein.search

import java.nio.file.{Files, InvalidPathException, Path}
import java.security.MessageDigest
import java.util.HexFormat

/** Files that a question names: what they held when it was asked. */
object NamedFiles:
  /** SHA-256 of those of the names that are files, with or without a word and a colon before (`file:`,
    * `mujoco:`).
    */
  def digests(names: Seq[String]): Map[String, String] =
    (for
      name <- names
      path <- Seq(name, name.dropWhile(_ != ':').drop(1)).filter(isFile)
    yield path -> HexFormat.of.formatHex(MessageDigest.getInstance("SHA-256").digest(
      Files.readAllBytes(Path.of(path))
    ))).toMap

  private def isFile(name: String) =
    try name.nonEmpty && Files.isRegularFile(Path.of(name))
    catch case _: InvalidPathException => false

  /** Which of the files hold something else now, or are gone.
    *
    * @param before of [[digests]]
    */
  def changed(before: Map[String, String]): Vector[String] =
    before.filter((path, digest) => !digests(Seq(path)).get(path).contains(digest)).keys.toVector.sorted
