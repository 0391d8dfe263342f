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

/** Folders that commands write into. */
private[cli] object OutFolder:

  private val Lock = ".skein.lock"

  /** Those that the calling thread's command has made, the inner ones first. */
  private val fresh = ThreadLocal.withInitial[Vector[Path]](() => Vector.empty)

  /** What a command does that tells why it cannot be done; then a folder that it made, and wrote nothing
    * into, is gone.
    */
  def unlessRefused[A](command: => Either[String, A]): Either[String, A] =
    fresh.remove()
    val done = command
    if done.isLeft then
      try
        for folder <- fresh.get do
          if Option(folder.toFile.list).exists(_.sameElements(Seq(Lock))) then
            Files.delete(folder.resolve(Lock))
          Files.delete(folder)
      catch case _: IOException => () // there is something in it
    done

  /** Makes the folder if need be and sees whether files can be written there, so that a command of minutes
    * does not fail at its end.
    *
    * @param option that names the folder, for example `--out`
    * @return or why not, in a line
    */
  def made(option: String, text: String): Either[String, Path] =
    if text.isEmpty then Left(s"$option: expected a folder, came ''")
    else
      val folder = Path.of(text)
      try
        val missing =
          Iterator.iterate(folder.toAbsolutePath)(_.getParent).takeWhile(Files.notExists(_)).toVector
        // One by one: where `gone` is missing, so is `gone/..`, until `gone` is made.
        for part <- missing.reverse if Files.notExists(part) do
          Files.createDirectories(part)
          fresh.set(part +: fresh.get)
        Files.delete(Files.createTempFile(folder, ".skein", ""))
        Right(folder)
      catch
        case failed: IOException =>
          Left(s"$option: cannot write into the folder $folder: ${FileReason.of(failed)}")

  /** A name that is new every second. */
  def dated(parent: String): String =
    s"$parent/${LocalDateTime.now().format(DateTimeFormatter.ofPattern("yyyy-MM-dd-HHmmss"))}"

  /** The folder of a file; of the root, itself. */
  def of(file: Path): String =
    val whole = file.toAbsolutePath
    Option(whole.getParent).getOrElse(whole).toString

  /** Runs `body` as the only command at work in a folder.
    *
    * @return or that another is
    */
  def alone[A](folder: Path)(body: => Either[String, A]): Either[String, A] =
    val other = Left(s"another command is at work in $folder; expected it to end first")
    try
      Using.resource(FileChannel.open(folder.resolve(Lock), CREATE, WRITE)): channel =>
        // Without a lock that this process holds already.
        Option(channel.tryLock()).fold(other)(_ => body)
    catch
      case _: OverlappingFileLockException => other
      case failed: IOException             => Left(s"cannot write into $folder: ${FileReason.of(failed)}")

  /** Writes files by their names.
    *
    * @return where they are, or why not, in a line
    */
  def write(folder: Path, files: Seq[(String, Array[Byte])]): Either[String, Vector[Path]] =
    try Right(files.toVector.map((name, bytes) => Files.write(folder.resolve(name), bytes)))
    catch case failed: IOException => Left(s"cannot write into $folder: ${FileReason.of(failed)}")

  def text(name: String, text: String): (String, Array[Byte]) = (name, text.getBytes(UTF_8))

  /** `NAME.svg` and, where this machine can paint, `NAME.png`; where it cannot, that is said.
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

  /** Whether a file that an option names would stand in a folder. */
  def isThere(option: String, file: String): Either[String, Unit] =
    for
      _ <- Expect.that(file.nonEmpty)(s"$option: expected a file, came ''")
      _ <- Expect.that(Files.isDirectory(Path.of(file).toAbsolutePath.getParent)):
        s"$option: expected a file in a folder that is there, came $file"
    yield ()
