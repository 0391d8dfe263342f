package skein.search

import java.nio.file.{Files, InvalidPathException, Path}
import java.security.MessageDigest
import java.util.HexFormat
import skein.units.Expect

/** Digests of the files that a question names, to detect later changes. */
object NamedFiles:
  /** SHA-256 of the names that are files, with or without prefixes such as `mujoco:` or `loss:1%,file:`. */
  def digests(names: Seq[String]): Map[String, String] =
    (for
      name <- names
      path <- (name +: name.indices.filter(name(_) == ':').map(at => name.drop(at + 1))).filter(isFile)
    yield path -> sha256(Path.of(path))).toMap

  private def sha256(file: Path) =
    HexFormat.of.formatHex(MessageDigest.getInstance("SHA-256").digest(Files.readAllBytes(file)))

  private def isFile(name: String) =
    try name.nonEmpty && Files.isRegularFile(Path.of(name))
    catch case _: InvalidPathException => false

  /** Files that have changed since, or no longer exist.
    *
    * @param before result of [[digests]]
    */
  def changed(before: Map[String, String]): Vector[String] =
    before.filter((path, digest) => !digests(Seq(path)).get(path).contains(digest)).keys.toVector.sorted

  /** @param before result of [[digests]]
    * @param began what has begun, for example `the search`
    * @return Left names the files whose change forbids continuing
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
