package skein.cli

import java.io.IOException
import java.nio.channels.{FileChannel, OverlappingFileLockException}
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.{Files, Path}
import java.nio.file.StandardOpenOption.{CREATE, WRITE}
import java.time.LocalDateTime
import java.time.format.DateTimeFormatter
import scala.util.Using
import skein.plot.{Drawing, Png, Svg}
import skein.record.FileReason
import skein.units.Expect

/** Creates and writes the output folders of commands. */
private[cli] object OutFolder:

  private val Lock = ".skein.lock"

  /** Folders created by the calling thread's command, innermost first. */
  private val fresh = ThreadLocal.withInitial[Vector[Path]](() => Vector.empty)

  /** Runs a command; if it is refused, deletes the folders that it created and wrote nothing to. */
  def unlessRefused[A](command: => Either[String, A]): Either[String, A] =
    fresh.remove()
    val done = command
    if done.isLeft then
      try
        for folder <- fresh.get do
          if Option(folder.toFile.list).exists(_.sameElements(Seq(Lock))) then
            Files.delete(folder.resolve(Lock))
          Files.delete(folder)
      catch case _: IOException => () // not empty
    done

  /** Creates the folder if necessary and checks that it is writable, so that a long command does not fail at
    * its end.
    *
    * @param option the option that names the folder, for example `--out`
    * @return Left says in a line why it cannot be written
    */
  def made(option: String, text: String): Either[String, Path] =
    if text.isEmpty then Left(s"$option: expected a folder, got ''")
    else
      val folder = Path.of(text)
      FileReason.attempt(why => s"$option: cannot write into the folder $folder: $why"):
        val missing =
          Iterator.iterate(folder.toAbsolutePath)(_.getParent).takeWhile(Files.notExists(_)).toVector
        // One by one: if `gone` is missing, so is `gone/..`, until `gone` is made.
        for part <- missing.reverse if Files.notExists(part) do
          Files.createDirectories(part)
          fresh.set(part +: fresh.get)
        Files.delete(Files.createTempFile(folder, ".skein", ""))
        folder

  /** A folder name made of the date and time, in seconds. */
  def dated(parent: String): String =
    s"$parent/${LocalDateTime.now().format(DateTimeFormatter.ofPattern("yyyy-MM-dd-HHmmss"))}"

  /** The folder of a file; the root, for the root itself. */
  def of(file: Path): String =
    val whole = file.toAbsolutePath
    Option(whole.getParent).getOrElse(whole).toString

  /** Runs `body` as the only command that writes to a folder.
    *
    * @return Left if another command does
    */
  def alone[A](folder: Path)(body: => Either[String, A]): Either[String, A] =
    val other = Left(s"another command is at work in $folder; expected it to end first")
    try
      Using.resource(FileChannel.open(folder.resolve(Lock), CREATE, WRITE)): channel =>
        // None if another process holds the lock.
        Option(channel.tryLock()).fold(other)(_ => body)
    catch
      case _: OverlappingFileLockException => other
      case failed: IOException             => Left(s"cannot write into $folder: ${FileReason.of(failed)}")

  /** Writes files by their names.
    *
    * @return their paths, or Left with the reason in a line
    */
  def write(folder: Path, files: Seq[(String, Array[Byte])]): Either[String, Vector[Path]] =
    FileReason.attempt(why => s"cannot write into $folder: $why"):
      files.toVector.map((name, bytes) => Files.write(folder.resolve(name), bytes))

  def text(name: String, text: String): (String, Array[Byte]) = (name, text.getBytes(UTF_8))

  /** Writes `NAME.svg` and, if this machine can render it, `NAME.png`; else states why there is no PNG.
    *
    * @param scale pixels for a unit of the drawing
    */
  def picture(
      name: String,
      drawing: Drawing,
      title: String,
      scale: Double = 3
  ): Vector[(String, Array[Byte])] =
    val painted = Png.bytes(drawing, scale)
    painted.left.foreach(reason => Console.err.println(s"no PNG: $reason"))
    text(s"$name.svg", Svg.file(drawing, title)) +: painted.toOption.map(s"$name.png" -> _).toVector

  /** Checks that the folder of a file named by an option exists. */
  def isThere(option: String, file: String): Either[String, Unit] =
    for
      _ <- Expect.that(file.nonEmpty)(s"$option: expected a file, got ''")
      _ <- Expect.that(Files.isDirectory(Path.of(file).toAbsolutePath.getParent)):
        s"$option: expected a file in a folder that is there, got $file"
    yield ()
