package skein.mcap

import java.nio.charset.StandardCharsets.UTF_8
import java.nio.charset.{CharacterCodingException, CodingErrorAction}
import java.nio.{ByteBuffer, ByteOrder}
import scala.collection.immutable.{SeqMap, VectorMap}

/** Reads the fields of one record, in order. Bytes after the last field read belong to a later version of the
  * specification, or are padding.
  */
private[mcap] final class Fields(array: Array[Byte], from: Int, until: Int, record: String, place: Place):
  private val view = ByteBuffer.wrap(array).order(ByteOrder.LITTLE_ENDIAN)
  private var at   = from

  private def take(count: Long, field: String): Int =
    if count < 0 || count > until - at then short(count, field)
    val start = at
    at = start + count.toInt
    start

  private def short(count: Long, field: String): Nothing =
    Refused.malformed(
      place,
      s"${java.lang.Long.toUnsignedString(count)} bytes of $field at byte ${at - from} of its $record record",
      s"${until - at}, the end of the record"
    )

  def u8(field: String): Int   = array(take(1, field)) & 0xff
  def u16(field: String): Int  = view.getShort(take(2, field)) & 0xffff
  def u32(field: String): Int  = view.getInt(take(4, field))
  def u64(field: String): Long = view.getLong(take(8, field))

  def bytes32(field: String): Bytes = bytes(u32(field) & 0xffffffffL, field)
  def bytes64(field: String): Bytes = bytes(u64(field), field)
  def rest(): Bytes                 = bytes(until - at, "the rest")

  private def bytes(count: Long, field: String): Bytes =
    val start = take(count, field)
    Bytes.of(array, start, at)

  def string(field: String): String =
    val length = u32(field) & 0xffffffffL
    val start  = take(length, field)
    try
      UTF_8.newDecoder
        .onMalformedInput(CodingErrorAction.REPORT)
        .onUnmappableCharacter(CodingErrorAction.REPORT)
        .decode(ByteBuffer.wrap(array, start, at - start))
        .toString
    catch
      case _: CharacterCodingException =>
        Refused.malformed(place, s"UTF-8 in $field of its $record record", "other bytes")

  def strings(field: String): SeqMap[String, String] = map(field)(string(field) -> string(field))
  def numbers(field: String): SeqMap[Int, Long]      = map(field)(u16(field) -> u64(field))

  private def map[K, V](field: String)(entry: => (K, V)): SeqMap[K, V] =
    val entries = elements(field)(entry)
    val known   = entries.to(VectorMap)
    if known.size < entries.size then
      Refused.malformed(place, s"each key once in $field of its $record record", "one that stands twice")
    known

  private def elements[A](field: String)(element: => A): Vector[A] =
    val length = u32(field) & 0xffffffffL
    val start  = take(length, field)
    val end    = at
    at = start
    val found = Vector.newBuilder[A]
    while at < end do found += element
    if at > end then
      Refused.malformed(
        place,
        s"$field of ${end - start} bytes in its $record record",
        s"${at - start} bytes"
      )
    found.result()

  def crc: Int = Checksum.of(array, from, at)

  def expectEnd(): Unit =
    if at < until then
      Refused.malformed(place, s"a $record record of ${at - from} bytes", s"one of ${until - from}")
