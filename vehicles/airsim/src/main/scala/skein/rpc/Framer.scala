package skein.rpc

import org.apache.pekko.util.ByteString

/** Bounds on the memory for one message of a peer.
  *
  * @param frameBytes longest encoded message, bytes
  * @param depth deepest nesting of arrays and maps; the message's own array counts as one
  * @param elements maximum number of values in one message, counting every key, value and array element
  * @param keys maximum number of keys in one map. A peer can choose keys whose hashes are equal; then each
  *   key added to a map is compared with all before it, so this bounds the comparisons a key costs
  * @param maps maximum number of maps in one message: even an empty one, a single byte, becomes an object of
  *   some 150 bytes
  */
final case class FrameLimits(
    frameBytes: Int = 64 << 20,
    depth: Int = 64,
    elements: Int = 4 << 20,
    keys: Int = 128,
    maps: Int = 1 << 18
):
  require(
    frameBytes > 0 && depth > 0 && elements > 0 && keys > 0 && maps > 0,
    s"limits must be positive: $this"
  )

object FrameLimits:
  /** Limits of a listener that keeps only the beginning of a message, however long it is: see [[Framer]]. */
  val Listening: FrameLimits = FrameLimits(frameBytes = Int.MaxValue, elements = Int.MaxValue)

/** The result of reading on from a [[Framer]]. */
enum Framed:
  /** The encoded bytes of exactly one MessagePack value. */
  case Complete(bytes: Array[Byte])

  /** All bytes offered so far are consumed; the next value is not complete. */
  case NeedsMore

  /** The bytes are not MessagePack, or a limit is exceeded. The stream is out of step for good: every later
    * call returns this result.
    */
  case Malformed(reason: String)

/** Cuts a byte stream into MessagePack values, over any segmentation. Each header is read once: the state is
  * the number of values outstanding at each open level and of payload bytes to skip, so nothing is parsed
  * twice. A value's bytes are copied once, when it is complete. Does no I/O; one instance per connection and
  * direction, one thread at a time.
  *
  * @param keptBytes keeps only about this many bytes from the beginning of a longer value: for a listener
  *   that needs no more of an image
  */
final class Framer(limits: FrameLimits = FrameLimits(), keptBytes: Int = Int.MaxValue):
  import Framer.*

  private var segment    = EmptySegment
  private var position   = 0
  private var frameStart = 0 // where the current value begins in `segment`; 0 if in an earlier one
  private var earlier        = List.empty[Array[Byte]] // latest first
  private var earlierBytes   = 0                       // in `earlier` and `crumbs` together
  private var passedBytes    = 0L                      // of the current value, parsed and not kept
  private var lastBytes      = 0L
  private val crumbs         = new Array[Byte](CrumbsCapacity)
  private var crumbBytes     = 0
  private var payloadToSkip  = 0L
  private val outstanding    = new Array[Long](limits.depth + 1)
  private var level          = 0
  private var elements       = 0L
  private var maps           = 0
  private var decoded        = 0L
  private val header         = new Array[Byte](MaxHeader)
  private var headerBytes    = 0
  private var headerExpected = 0
  private var refusal        = Option.empty[Framed]

  /** Adds the next bytes from the peer. May be called only after [[next]] has returned [[Framed.NeedsMore]].
    */
  def offer(bytes: ByteString): Unit =
    require(position == segment.length, "the previous segment is not consumed yet")
    segment = bytes.toArrayUnsafe()
    position = 0
    frameStart = 0

  /** The next complete value, if the bytes offered so far hold one. */
  def next(): Framed =
    refusal.getOrElse:
      try scan()
      catch
        case refused: Refused =>
          refusal = Some(Framed.Malformed(refused.getMessage))
          refusal.get

  /** Whether the peer has sent part of a value: a stream that ends now cuts a message. */
  def midway: Boolean = earlierBytes > 0 || position > frameStart

  def heldBytes: Int = earlierBytes

  /** Approximate memory of the last completed value once it is decoded, bytes. */
  def decodedBytes: Long = decoded

  /** Length of the last completed value, including bytes that were not kept. */
  def valueBytes: Long = lastBytes

  private def scan(): Framed =
    var complete = false
    while !complete && position < segment.length do
      if payloadToSkip > 0 then
        val skipped = math.min(payloadToSkip, segment.length - position).toInt
        position += skipped
        payloadToSkip -= skipped
      else readHeader()
      if payloadToSkip == 0 && headerBytes == 0 then complete = closeLevels()
    if complete then Framed.Complete(take())
    else
      keep()
      Framed.NeedsMore

  /** Reads one header, or as much of it as the segment holds. Sets `payloadToSkip` and opens levels. */
  private def readHeader(): Unit =
    if headerBytes == 0 then
      val marker = segment(position) & 0xff
      val length = lengthBytes(marker)
      if length == 0 then
        position += 1
        open(marker, 0L)
      else if segment.length - position > length then
        val size = bigEndian(segment, position + 1, length)
        position += 1 + length
        open(marker, size)
      else
        headerExpected = 1 + length
        collectHeader()
    else collectHeader()

  private def collectHeader(): Unit =
    val taken = math.min(headerExpected - headerBytes, segment.length - position)
    System.arraycopy(segment, position, header, headerBytes, taken)
    headerBytes += taken
    position += taken
    if headerBytes == headerExpected then
      headerBytes = 0
      open(header(0) & 0xff, bigEndian(header, 1, headerExpected - 1))

  /** Begins one value: `size` is its header's length field, 0 if it has none. */
  private def open(marker: Int, size: Long): Unit =
    if marker == NeverUsed then throw Refused("byte 0xc1, which MessagePack never uses")
    val children = childCount(marker, size)
    if isMap(marker) then
      maps += 1
      if children / 2 > limits.keys then
        throw Refused(s"a map of ${children / 2} keys; at most ${limits.keys} are accepted")
      if maps > limits.maps then
        throw Refused(s"a message of at least $maps maps; at most ${limits.maps} are accepted")
    if children > 0 then
      if level == limits.depth then throw Refused(s"nested deeper than ${limits.depth} levels")
      elements += children
      if elements > limits.elements then
        throw Refused(s"a message of at least $elements values; at most ${limits.elements} are accepted")
      level += 1
      outstanding(level) = children + 1 // the container itself is closed with its last child
    else payloadToSkip = payloadBytes(marker, size)
    val least = frameBytesSoFar + payloadToSkip + math.max(children, 0L)
    if least > limits.frameBytes then
      throw Refused(s"a message of at least $least bytes; at most ${limits.frameBytes} are accepted")

  /** Completes a value, or a container's header. True if that completes the outermost value. */
  private def closeLevels(): Boolean =
    var closing = true
    while closing && level > 0 do
      outstanding(level) -= 1
      if outstanding(level) == 0 then level -= 1
      else closing = false
    level == 0

  private def frameBytesSoFar: Long = earlierBytes + passedBytes + (position - frameStart)

  /** Keeps the segment's part of an incomplete value: large parts by reference, small parts gathered, so that
    * single bytes do not cost one object each.
    */
  private def keep(): Unit =
    val length = position - frameStart
    if earlierBytes >= keptBytes then passedBytes += length
    else
      if length > CrumbsCapacity / 4 then
        sweep()
        val part =
          if frameStart == 0 then segment else java.util.Arrays.copyOfRange(segment, frameStart, position)
        earlier = part :: earlier
      else if length > 0 then
        if crumbBytes + length > CrumbsCapacity then sweep()
        System.arraycopy(segment, frameStart, crumbs, crumbBytes, length)
        crumbBytes += length
      earlierBytes += length
    segment = EmptySegment
    position = 0
    frameStart = 0

  private def sweep(): Unit =
    if crumbBytes > 0 then
      earlier = java.util.Arrays.copyOf(crumbs, crumbBytes) :: earlier
      crumbBytes = 0

  private def take(): Array[Byte] =
    lastBytes = frameBytesSoFar
    val here  = if earlierBytes >= keptBytes then 0 else position - frameStart
    val frame = new Array[Byte](earlierBytes + here)
    var end   = earlierBytes - crumbBytes
    System.arraycopy(crumbs, 0, frame, end, crumbBytes)
    while earlier.nonEmpty do
      val part = earlier.head
      earlier = earlier.tail
      end -= part.length
      System.arraycopy(part, 0, frame, end, part.length)
    System.arraycopy(segment, frameStart, frame, earlierBytes, here)
    decoded = frame.length + elements * BytesPerValue + maps.toLong * BytesPerMap
    earlierBytes = 0
    passedBytes = 0
    crumbBytes = 0
    elements = 0
    maps = 0
    frameStart = position
    frame

private[rpc] object Framer:
  val NeverUsed              = 0xc1
  private val MaxHeader      = 5 // a marker and a length of up to four bytes
  private val CrumbsCapacity = 4096
  private val EmptySegment   = Array.emptyByteArray

  // Sizes of decoded values on a 64-bit JVM with compressed pointers, with the references to them.
  private val BytesPerValue = 32
  private val BytesPerMap   = 160

  private final class Refused(reason: String) extends RuntimeException(reason, null, false, false)

  /** Number of length bytes that follow the marker. */
  def lengthBytes(marker: Int): Int = marker match
    case 0xc4 | 0xc7 | 0xd9               => 1
    case 0xc5 | 0xc8 | 0xda | 0xdc | 0xde => 2
    case 0xc6 | 0xc9 | 0xdb | 0xdd | 0xdf => 4
    case _                                => 0

  /** Number of values in a container; 0 for anything else. */
  def childCount(marker: Int, size: Long): Long = marker match
    case 0xdc | 0xdd                 => size
    case 0xde | 0xdf                 => 2 * size
    case m if m >= 0x90 && m <= 0x9f => m & 0x0f
    case m if m >= 0x80 && m <= 0x8f => 2L * (m & 0x0f)
    case _                           => 0

  private def isMap(marker: Int): Boolean = (marker & 0xf0) == 0x80 || marker == 0xde || marker == 0xdf

  /** Number of bytes between the header and the end of the value. */
  def payloadBytes(marker: Int, size: Long): Long = marker match
    case 0xcc | 0xd0                             => 1
    case 0xcd | 0xd1                             => 2
    case 0xca | 0xce | 0xd2                      => 4
    case 0xcb | 0xcf | 0xd3                      => 8
    case 0xc4 | 0xc5 | 0xc6 | 0xd9 | 0xda | 0xdb => size
    case 0xc7 | 0xc8 | 0xc9                      => size + 1 // an extension's type byte
    case m if m >= 0xd4 && m <= 0xd8             => 1 + (1 << (m - 0xd4))
    case m if m >= 0xa0 && m <= 0xbf             => m & 0x1f
    case _                                       => 0

  private def bigEndian(bytes: Array[Byte], from: Int, count: Int): Long =
    var value = 0L
    var i     = from
    while i < from + count do
      value = (value << 8) | (bytes(i) & 0xff)
      i += 1
    value
