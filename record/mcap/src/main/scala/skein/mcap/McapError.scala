package skein.mcap

import scala.util.control.NoStackTrace

/** A position in a file.
  *
  * @param offset bytes from the start of the file
  * @param inChunk offset in the uncompressed records of the chunk that starts at `offset`; -1 outside of
  *   chunks
  */
final case class Place(offset: Long, inChunk: Int = -1):
  override def toString: String =
    if inChunk < 0 then s"byte $offset" else s"byte $inChunk of the records of the chunk at byte $offset"

/** The reasons why a file, or its end, cannot be read, with the position, what was expected and what was
  * found.
  */
enum McapError:

  /** The file does not begin with MCAP's magic bytes, or begins with those of an unknown version. */
  case NotMcap(came: Bytes)

  /** The file ends too early, like that of a killed writer. Everything before its end has been read. */
  case CutOff(at: Place, expected: String, came: Long)

  /** The file states a size beyond the reader's limit. */
  case TooLarge(at: Place, what: String, claimed: Long, limit: Long)

  /** The file does not have the structure of an MCAP file. */
  case Malformed(at: Place, expected: String, came: String)

  /** A CRC does not match: bytes have changed since they were written. */
  case WrongCrc(at: Place, what: String, expected: Int, came: Int)

  /** The bytes of a chunk are not valid output of its compression. */
  case NotDecompressed(at: Place, compression: String, why: String)

  /** The chunk's compression is neither `zstd` nor `lz4` nor none. */
  case UnknownCompression(at: Place, name: String)

  def message: String = this match
    case NotMcap(came) =>
      s"byte 0: expected an MCAP file of version 0, which begins with ${McapError.hex(Magic.bytes)}, got " +
        (if came.size == 0 then "no byte" else McapError.hex(came))
    case CutOff(at, expected, came) => s"$at: the file is cut off: expected $expected, got $came bytes"
    case TooLarge(at, what, claimed, limit) =>
      s"$at: $what claims ${java.lang.Long.toUnsignedString(claimed)} bytes, expected at most $limit"
    case Malformed(at, expected, came)      => s"$at: expected $expected, got $came"
    case WrongCrc(at, what, expected, came) =>
      s"$at: the CRC of $what is written as ${Hex.of(expected)}, its bytes give ${Hex.of(came)}"
    case NotDecompressed(at, compression, why) =>
      s"$at: expected a chunk compressed by $compression, got $why"
    case UnknownCompression(at, name) =>
      s"$at: expected a chunk compressed by zstd, by lz4 or not at all, got \"$name\""

  override def toString: String = message

object McapError:
  private def hex(bytes: Bytes) = bytes.toArray.map(Hex.ofByte(_)).mkString(" ")

/** The magic bytes at both ends of a file. */
private[mcap] object Magic:
  val bytes: Bytes = Bytes.of(Array[Byte](0x89.toByte, 'M', 'C', 'A', 'P', '0', '\r', '\n'))

/** Carries an error out of the decoder, whose public methods all return an `Either`. */
private[mcap] final class Refused(val error: McapError) extends RuntimeException(error.message)
    with NoStackTrace

private[mcap] object Refused:
  def malformed(at: Place, expected: String, came: String): Nothing =
    throw Refused(McapError.Malformed(at, expected, came))

  def either[A](body: => A): Either[McapError, A] =
    try Right(body)
    catch case refused: Refused => Left(refused.error)
