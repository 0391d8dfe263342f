package skein.mcap

import java.nio.{ByteBuffer, ByteOrder}

/** Iterates over consecutive records.
  *
  * @param offset position of the first record in the file; with `inChunk`, position of its chunk
  * @param cut whether the records may end within one, which is then left out
  */
private[mcap] final class RecordWalk(records: Bytes, offset: Long, inChunk: Boolean, cut: Boolean = false):
  private val array = records.array
  private val end   = records.from + records.size
  private val view  = ByteBuffer.wrap(array).order(ByteOrder.LITTLE_ENDIAN)
  private var at    = records.from
  private var next  = records.from

  /** Advances to the next record; false if there is none. */
  def step(): Boolean =
    at = next
    if at == end then false
    else if end - at < 9 then missing("9 bytes of a record's kind and length")
    else
      val length = view.getLong(at + 1)
      if java.lang.Long.compareUnsigned(length, end - at - 9L) > 0 then
        missing(s"${java.lang.Long.toUnsignedString(length)} bytes of ${Opcode.name(opcode)}")
      else
        next = at + 9 + length.toInt
        true

  private def missing(expected: String): Boolean =
    if cut then false else Refused.malformed(place, expected, s"${(end - at - 9).max(0)} bytes to the end")

  def opcode: Int    = array(at) & 0xff
  def length: Int    = next - at
  def place: Place   = if inChunk then Place(offset, at - records.from) else Place(offset + at - records.from)
  def record: Record = RecordCodec.decode(opcode, array, at + 9, next, place)
