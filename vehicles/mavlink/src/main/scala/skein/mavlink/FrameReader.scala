package skein.mavlink

import scala.collection.mutable

/** Counts of a reader.
  *
  * @param frames number of valid frames of known messages
  * @param lost number of frames that are missing according to the sequence numbers
  * @param unknown number of frames of unknown messages, which cannot be verified
  * @param badChecksum number of damaged frames, or other bytes that looked like one
  * @param badSignature number of frames without a signature, with a wrong one, or replayed
  * @param notUnderstood number of frames with flags that a receiver must understand
  * @param version1 number of frames of MAVLink 1
  * @param garbageBytes number of bytes outside of frames
  */
final case class ReaderCounts(
    frames: Long = 0,
    lost: Long = 0,
    unknown: Long = 0,
    badChecksum: Long = 0,
    badSignature: Long = 0,
    notUnderstood: Long = 0,
    version1: Long = 0,
    garbageBytes: Long = 0
):
  /** Frames that a peer which speaks MAVLink 2 did not mean. */
  def damaged: Long = badChecksum + unknown + notUnderstood

/** Decodes bytes to frames; after invalid input it resumes at the next frame. Holds one frame at most. Not
  * thread-safe.
  *
  * @param signing the key: with it, a frame without a valid signature is refused
  */
final class FrameReader(signing: Option[Signing] = None):
  import Frame.*

  private var pending   = Array.emptyByteArray
  private var counted   = ReaderCounts()
  private val sequences = mutable.HashMap.empty[(Int, Int), Int]

  def counts: ReaderCounts = counted

  /** Reads the next bytes of a stream, split anywhere. */
  def read(bytes: Array[Byte]): Vector[Frame] = read(bytes, isWhole = false)

  private def read(bytes: Array[Byte], isWhole: Boolean): Vector[Frame] =
    val all    = pending ++ bytes
    val frames = Vector.newBuilder[Frame]
    var at     = 0
    var isCut  = false
    while at < all.length && !isCut do
      step(all, at, isWhole) match
        case Step.Cut                 => isCut = true
        case Step.Skip(length)        => at += length
        case Step.Take(frame, length) =>
          frames += frame
          at += length
    pending = all.drop(at)
    frames.result()

  /** Reads a datagram: its bytes never continue in the next one. */
  def readDatagram(bytes: Array[Byte]): Vector[Frame] =
    val frames = read(bytes, isWhole = true)
    counted = counted.copy(garbageBytes = counted.garbageBytes + pending.length)
    pending = Array.emptyByteArray
    frames

  private enum Step:
    case Cut
    case Skip(length: Int)
    case Take(frame: Frame, length: Int)

  private def step(all: Array[Byte], at: Int, isWhole: Boolean): Step =
    def byte(offset: Int) = all(at + offset) & 0xff
    val left              = all.length - at
    byte(0) match
      case Start if left >= HeaderLength && (byte(2) & ~Signed) != 0 =>
        skip(1)(_.copy(notUnderstood = counted.notUnderstood + 1))
      case Start if left >= HeaderLength =>
        val frameEnd = HeaderLength + byte(1) + ChecksumLength
        val length   = frameEnd + (if (byte(2) & Signed) != 0 then SignatureLength else 0)
        val id       = byte(7) | byte(8) << 8 | byte(9) << 16
        checked(all, at, frameEnd, length, id, isWhole): definition =>
          val frame     = all.slice(at, at + frameEnd)
          val signature = all.slice(at + frameEnd, at + length)
          if !signing.forall(length > frameEnd && _.accepts(frame, signature, byte(5), byte(6))) then
            skip(length)(_.copy(badSignature = counted.badSignature + 1))
          else
            val message = definition.decode(frame.slice(HeaderLength, frameEnd - ChecksumLength))
            note(byte(5), byte(6), byte(4))
            Step.Take(Frame(byte(5), byte(6), byte(4), message, signing.isDefined), length)
      case StartVersion1 if left >= HeaderLengthVersion1 =>
        val length = HeaderLengthVersion1 + byte(1) + ChecksumLength
        checked(all, at, length, length, byte(5), isWhole): _ =>
          skip(length)(_.copy(version1 = counted.version1 + 1))
      case Start | StartVersion1 => Step.Cut
      case _                     => skip(1)(_.copy(garbageBytes = counted.garbageBytes + 1))

  /** Verifies a frame's checksum, which ends at `frameEnd`; the frame begins at `at` and has `length` bytes.
    */
  private def checked(all: Array[Byte], at: Int, frameEnd: Int, length: Int, id: Int, isWhole: Boolean)(
      valid: Definition[? <: Message] => Step
  ): Step =
    if all.length - at < length then Step.Cut
    else
      Dialect.of(id).fold(unknown(all, at, length, isWhole)): definition =>
        val end  = at + frameEnd - ChecksumLength
        val sum  = Checksum.Start.add(all, at + 1, end).add(definition.crcExtra).value
        val told = all(end) & 0xff | (all(end + 1) & 0xff) << 8
        if sum == told then valid(definition) else skip(1)(_.copy(badChecksum = counted.badChecksum + 1))

  /** Skips a frame whose checksum cannot be computed, if another follows it or the datagram ends; else only
    * its first byte, since the bytes may not be a frame.
    */
  private def unknown(all: Array[Byte], at: Int, length: Int, isWhole: Boolean): Step =
    val end = at + length
    if end == all.length && !isWhole then Step.Cut
    else
      val isFrame = end == all.length || Set(Start, StartVersion1)(all(end) & 0xff)
      skip(if isFrame then length else 1)(_.copy(unknown = counted.unknown + 1))

  private def skip(length: Int)(count: ReaderCounts => ReaderCounts): Step =
    counted = count(counted)
    Step.Skip(length)

  private def note(system: Int, component: Int, sequence: Int): Unit =
    val gap = sequences.get((system, component)).fold(0)(before => (sequence - before - 1) & 0xff)
    sequences((system, component)) = sequence
    counted = counted.copy(frames = counted.frames + 1, lost = counted.lost + gap)

object FrameReader:
  /** Whether these bytes contain a whole frame of a known message, of either version. */
  def isSpoken(bytes: Array[Byte]): Boolean =
    val reader = FrameReader()
    reader.read(bytes).nonEmpty || reader.counts.version1 > 0
