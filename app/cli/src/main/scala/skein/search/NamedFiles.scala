package skein.search

import java.nio.file.{Files, InvalidPathException, Path}
import java.security.MessageDigest
import java.util.HexFormat
import skein.units.Expect

/** Files that a question names: what they held when it was asked. */
object NamedFiles:
  /** SHA-256 of those of the names that are files, with or without a word and a colon before (`file:`,
    * `mujoco:`).
    */
  def digests(names: Seq[String]): Map[String, String] =
    (for
      name <- names
      path <- Seq(name, name.dropWhile(_ != ':').drop(1)).filter(isFile)
    yield path -> sha256(Path.of(path))).toMap

  private def sha256(file: Path) =
    HexFormat.of.formatHex(MessageDigest.getInstance("SHA-256").digest(Files.readAllBytes(file)))

  private def isFile(name: String) =
    try name.nonEmpty && Files.isRegularFile(Path.of(name))
    catch case _: InvalidPathException => false

  /** Which of the files hold something else now, or are gone.
    *
    * @param before of [[digests]]
    */
  def changed(before: Map[String, String]): Vector[String] =
    before.filter((path, digest) => !digests(Seq(path)).get(path).contains(digest)).keys.toVector.sorted

  /** @param before of [[digests]]
    * @param began for example `the search`
    * @return or which of the files do not let it be gone on with
    */
  def unchanged(before: Map[String, String], began: String): Either[String, Unit] =
    val (others, gone) = changed(before).partition(isFile)
    for
      _ <- gone.headOption.toLeft(()).left.map: missing =>
        val where = if Path.of(missing).isAbsolute then "" else ", from the folder in which it began"
        s"--resume: there is no file $missing, which $began read: expected to go on with it$where"
      _ <- Expect.that(others.isEmpty):
        s"--resume: ${others.mkString(", ")} no longer holds what it held when $began began: expected " +
          "the same, or to begin anew"
    yield ()
