package skein.search

import java.io.{BufferedOutputStream, FileNotFoundException, IOException, OutputStream}
import java.nio.channels.FileChannel
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.{Files, NoSuchFileException, Path, StandardCopyOption, StandardOpenOption}
import java.util.zip.CRC32C
import scala.util.Using
import skein.record.FileReason
import upickle.default.{ReadWriter, write as writeJson}

/** The state of a long computation as a JSON object on disk. It ends with a CRC-32C of all text before it:
  * damaged or edited values would otherwise be read as valid, and the continued run would end differently
  * from an uninterrupted one.
  *
  * @param name the file's name in its folder
  * @param version the object's version, its first field
  * @param what the state belongs to, in words, for example "a search"
  */
private[skein] final class StateFile[A: ReadWriter](name: String, version: Int, what: String):
  import StateFile.*

  /** The object's text; its last field is the checksum of all text before. */
  def json(state: A): String =
    val text = writeJson(state).stripSuffix("}")
    s"$text$Seal${sumOf(text)}}"

  /** Parses what [[json]] wrote; Left says what was expected and what was found. */
  def parse(text: String): Either[String, A] =
    val at = text.lastIndexOf(Seal)
    text match
      case Versioned(came) if came != version.toString   => Left(s"expected version $version, got $came")
      case Versioned(_) if at < 0 || !text.endsWith("}") =>
        Left(s"expected the state of $what with its checksum at the end, got a file that is cut off")
      case Versioned(_) if text.substring(at + Seal.length, text.length - 1) != sumOf(text.take(at)) =>
        Left(
          s"expected the state of $what as it was written; its " +
            "checksum says that it was damaged or edited since"
        )
      case Versioned(_) => JsonText.parse[A](text.take(at) + "}", s"the state of $what")
      case _            => Left(s"expected the state of $what, which begins with its version")

  /** Reads the file of a folder.
    *
    * @return Left says why the run cannot be continued
    */
  def read(folder: Path): Either[String, A] =
    val file = folder.resolve(name)
    try
      val within = Iterator.iterate(folder.toAbsolutePath)(_.getParent).takeWhile(_ != null)
      if Files.exists(file) && !Files.isRegularFile(file) then Left(s"$file: expected a file")
      else if within.exists(Files.isRegularFile(_)) then
        Left(s"$folder: expected the folder of $what, got a file")
      else parse(Files.readString(file)).left.map(mistake => s"$file: $mistake")
    catch
      case _: (NoSuchFileException | FileNotFoundException) =>
        Left(s"there is no $file; expected the folder of $what")
      case _: java.nio.charset.MalformedInputException =>
        Left(s"$file: expected the state of $what, got no text")
      case failed: IOException => Left(s"cannot read $file, the state of $what: ${FileReason.of(failed)}")

  /** Replaces the file atomically: a crash leaves the old or the new content.
    *
    * @return Left says why not
    */
  def write(folder: Path, state: A): Either[String, Unit] =
    replace(folder.resolve(name), folder.resolve(s"$name.new"))(_.write(json(state).getBytes(UTF_8)))

private[skein] object StateFile:
  private val Seal      = ",\"crc32c\":"
  private val Versioned = """(?s)\{"version":(\d{1,9}),.*""".r

  private def sumOf(text: String): String =
    val sum = CRC32C()
    sum.update(text.getBytes("UTF-8"))
    sum.getValue.toString

  /** Replaces a file atomically: a crash leaves the old or the new content.
    *
    * @param part path of the temporary file; only a killed process leaves it behind
    * @return Left says why not
    */
  def replace(target: Path, part: Path)(write: OutputStream => Unit): Either[String, Unit] =
    try
      Using.resource(BufferedOutputStream(Files.newOutputStream(part), Buffer))(write)
      Using.resource(FileChannel.open(part, StandardOpenOption.WRITE))(_.force(true))
      Files.move(part, target, StandardCopyOption.ATOMIC_MOVE, StandardCopyOption.REPLACE_EXISTING)
      Right(())
    catch
      case failed: IOException =>
        part.toFile.delete(): Unit
        Left(s"cannot write $target: ${FileReason.of(failed)}")

  /** Size of the buffer for reading and writing, bytes. */
  val Buffer: Int = 1 << 20
