package skein.search

import java.io.{FileNotFoundException, IOException}
import java.nio.channels.FileChannel
import java.nio.file.{Files, NoSuchFileException, Path, StandardCopyOption, StandardOpenOption}
import java.util.zip.CRC32C

/** The state of a long computation as a JSON object on disk. It ends with a CRC-32C of all text before it: numbers that
  * were damaged or edited would still be numbers, and what goes on from them would end as no unbroken run does.
  *
  * @param name
  *   of the file, in its folder
  * @param version
  *   of the object, its first field
  * @param what
  *   it is the state of, in words, for example "a search"
  */
private[skein] final class StateFile(val name: String, version: Int, what: String):
  import StateFile.*

  /** @param json
    *   an object whose first field is `version`
    */
  def sealing(json: String): String =
    val text = json.stripSuffix("}")
    s"$text$Seal${sumOf(text)}}"

  /** @return
    *   `json` of what [[sealing]] made, or what was expected and came
    */
  def opened(text: String): Either[String, String] =
    val at = text.lastIndexOf(Seal)
    text match
      case Versioned(came) if came != version.toString   => Left(s"expected version $version, came $came")
      case Versioned(_) if at < 0 || !text.endsWith("}") =>
        Left(s"expected the state of $what with its checksum at the end, came a file that is cut off")
      case Versioned(_) =>
        Either.cond(
          text.substring(at + Seal.length, text.length - 1) == sumOf(text.take(at)),
          text.take(at) + "}",
          s"expected the state of $what as it was written; its checksum says that it was damaged or edited since"
        )
      case _ => Left(s"expected the state of $what, which begins with its version")

  /** The file's text, without its checksum.
    *
    * @return
    *   or why it cannot be gone on with
    */
  def read(folder: Path): Either[String, String] =
    val file = folder.resolve(name)
    try
      if Files.exists(file) && !Files.isRegularFile(file) then Left(s"$file: expected a file")
      else opened(Files.readString(file)).left.map(mistake => s"$file: $mistake")
    catch
      case _: (NoSuchFileException | FileNotFoundException) =>
        Left(s"there is no $file; expected the folder of $what")
      case _: java.nio.charset.MalformedInputException =>
        Left(s"$file: expected the state of $what, came no text")
      case failed: IOException => Left(s"cannot read $file, the state of $what: $failed")

  /** Replaces the file, so that whatever happens there is the old one or the new one.
    *
    * @return
    *   or why not
    */
  def write(folder: Path, json: String): Either[String, Unit] =
    val target  = folder.resolve(name)
    val written = folder.resolve(s"$name.new")
    try
      Files.writeString(written, sealing(json))
      force(written)
      Files.move(written, target, StandardCopyOption.ATOMIC_MOVE, StandardCopyOption.REPLACE_EXISTING)
      Right(())
    catch case failed: IOException => Left(s"cannot write $target: $failed")

private[skein] object StateFile:
  private val Seal      = ",\"crc32c\":"
  private val Versioned = """(?s)\{"version":(\d{1,9}),.*""".r

  private def sumOf(text: String): String =
    val sum = CRC32C()
    sum.update(text.getBytes("UTF-8"))
    sum.getValue.toString

  /** All that was written to the file is on the disk when this returns. */
  def force(file: Path): Unit =
    val channel = FileChannel.open(file, StandardOpenOption.WRITE)
    try channel.force(true)
    finally channel.close()
