package skein.simulator

import java.io.IOException
import java.nio.charset.StandardCharsets.US_ASCII
import java.nio.file.{Files, InvalidPathException, LinkOption, Path, StandardOpenOption}
import java.util.concurrent.atomic.AtomicBoolean
import scala.util.Using

/** The only folder to which clients can have files written: voxel grids. One grid is made at a time, and the
  * folder holds at most [[GridFolder.Most]] files.
  */
private[simulator] final class GridFolder(folder: Path):
  import GridFolder.*

  private val isBusy = AtomicBoolean()

  /** @param path the client's path: a name in the folder, or a path to one
    * @return the file, or why none is written there
    */
  def file(path: String): Either[String, Path] =
    try
      val asked = Path.of(path)
      val name  = asked.getFileName
      if !path.endsWith(Ending) || name == null then Left(s"expected a name that ends in $Ending")
      else if asked.getParent != null && asked.toAbsolutePath.normalize.getParent != home then
        Left(s"voxel grids are written to $home alone; expected a name without a folder")
      else Right(home.resolve(name))
    catch case _: InvalidPathException => Left(s"expected a name that ends in $Ending")

  /** Makes a grid and writes it to `file`, replacing nothing but another grid. Returns whether it succeeded.
    * Throws [[BadArgument]] while another grid is being made.
    */
  def save(file: Path)(render: => Array[Byte]): Boolean =
    if !isBusy.compareAndSet(false, true) then
      throw BadArgument("another voxel grid is being made; one is made at a time")
    try mayWrite(file) && written(file, render)
    catch case _: IOException => false
    finally isBusy.set(false)

  private def home = folder.toAbsolutePath.normalize

  private def written(file: Path, content: Array[Byte]) =
    Files.write(
      file,
      content,
      StandardOpenOption.CREATE,
      StandardOpenOption.TRUNCATE_EXISTING,
      StandardOpenOption.WRITE,
      LinkOption.NOFOLLOW_LINKS
    )
    true

  private def mayWrite(file: Path): Boolean =
    if Files.exists(file, LinkOption.NOFOLLOW_LINKS) then
      Files.isRegularFile(file, LinkOption.NOFOLLOW_LINKS) &&
      Using.resource(Files.newInputStream(file))(_.readNBytes(Magic.length).sameElements(Magic))
    else
      Using.resource(Files.list(folder)): files =>
        files.filter(_.toString.endsWith(Ending)).limit(Most.toLong).count < Most

private[simulator] object GridFolder:
  /** Maximum number of grids in the folder; a grid has a few MB at most. */
  val Most = 100

  private val Ending = ".binvox"
  private val Magic  = "#binvox".getBytes(US_ASCII)
