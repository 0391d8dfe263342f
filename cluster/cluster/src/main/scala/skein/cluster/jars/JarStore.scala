package skein.cluster.jars

import java.io.IOException
import java.nio.file.attribute.PosixFilePermissions
import java.nio.file.{FileSystems, Files, Path, StandardCopyOption}
import scala.collection.immutable.ArraySeq
import scala.util.Using

/** Jars that came from elsewhere, by what is in them. Each is checked whenever it is asked for, before
  * anybody runs it.
  */
final class JarStore(val folder: Path):

  /** Where a jar lies, if it is here and whole. */
  private[jars] def find(jar: Jar): Option[Path] =
    val file = fileOf(jar)
    Option.when(
      Files.isRegularFile(file) && Files.size(file) == jar.bytes && Sha256.of(file) == jar.sha256
    )(file)

  /** Takes a jar in, by pieces one after the other. It is here once it is whole, and what it should be.
    *
    * @param piece that begins at an offset; empty where there is nothing
    */
  private[jars] def add(jar: Jar)(
      piece: Long => Either[NotFetched, ArraySeq[Byte]]
  ): Either[NotFetched, Path] =
    def refused(wrong: String) = Left(NotFetched.Refused(s"the jar ${jar.sha256} $wrong"))
    try
      JarStore.makeOurs(folder)
      val part = Files.createTempFile(folder, "jar", ".part")
      try
        val digest = Sha256.algorithm()
        val got    = Using.resource(Files.newOutputStream(part)): out =>
          def from(offset: Long): Either[NotFetched, Unit] =
            if offset == jar.bytes then Right(())
            else
              piece(offset) match
                case Left(why)                     => Left(why)
                case Right(bytes) if bytes.isEmpty =>
                  refused(s"is cut off after $offset of ${jar.bytes} bytes")
                case Right(bytes) if bytes.length > jar.bytes - offset =>
                  refused(s"goes on after its ${jar.bytes} bytes")
                case Right(bytes) =>
                  digest.update(bytes.toArray)
                  out.write(bytes.toArray)
                  from(offset + bytes.length)
          from(0)
        got.flatMap: _ =>
          val came = Sha256.told(digest.digest())
          if came != jar.sha256 then refused(s"came with other bytes, $came")
          else Right(Files.move(part, fileOf(jar), StandardCopyOption.REPLACE_EXISTING))
      finally Files.deleteIfExists(part): Unit
    catch case failed: IOException => Left(NotFetched.Refused(s"cannot keep jars in $folder: $failed"))

  private def fileOf(jar: Jar) = folder.resolve(s"${jar.sha256}.jar")

object JarStore:
  /** Others on this machine put nothing there. */
  private def makeOurs(folder: Path): Unit =
    Files.createDirectories(folder)
    if FileSystems.getDefault.supportedFileAttributeViews.contains("posix") then
      Files.setPosixFilePermissions(folder, PosixFilePermissions.fromString("rwx------")): Unit

  /** Of this user, `~/.cache/skein/jars` unless `XDG_CACHE_HOME` says otherwise. */
  def ofUser: JarStore =
    val caches = sys.env.get("XDG_CACHE_HOME").filter(_.nonEmpty).map(Path.of(_))
      .getOrElse(Path.of(sys.props("user.home"), ".cache"))
    JarStore(caches.resolve("skein").resolve("jars"))
