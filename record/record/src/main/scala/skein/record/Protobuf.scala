package skein.record

import com.google.protobuf.{CodedInputStream, CodedOutputStream, WireFormat}
import java.io.{ByteArrayOutputStream, IOException}
import skein.mcap.Bytes

/** Encodes a message of Protocol Buffers field by field: a subset for viewers' large messages, which would be
  * a third larger as JSON.
  */
private[record] final class Protobuf(expected: Int = 64):
  private val written = ByteArrayOutputStream(expected)
  private val out     = CodedOutputStream.newInstance(written)

  private def wrote(field: Unit): Protobuf = this

  def varint(field: Int, value: Long): Protobuf       = wrote(out.writeUInt64(field, value))
  def fixed32(field: Int, value: Int): Protobuf       = wrote(out.writeFixed32(field, value))
  def double(field: Int, value: Double): Protobuf     = wrote(out.writeDouble(field, value))
  def bytes(field: Int, value: Array[Byte]): Protobuf = wrote(out.writeByteArray(field, value))
  def text(field: Int, value: String): Protobuf       = wrote(out.writeString(field, value))
  def message(field: Int, value: Protobuf): Protobuf  = bytes(field, value.result)

  def result: Array[Byte] =
    out.flush()
    written.toByteArray

private[record] object Protobuf:

  /** The last field of this number that contains bytes.
    *
    * @return None without one, or if the message is damaged
    */
  def bytesOf(message: Bytes, field: Int): Option[Bytes] =
    val in    = CodedInputStream.newInstance(message.toArray)
    var found = Option.empty[Bytes]
    try
      var tag = in.readTag()
      while tag != 0 do
        val isBytes = WireFormat.getTagWireType(tag) == WireFormat.WIRETYPE_LENGTH_DELIMITED
        if isBytes && WireFormat.getTagFieldNumber(tag) == field then
          found = Some(Bytes.of(in.readByteArray()))
        else in.skipField(tag): Unit
        tag = in.readTag()
      found
    catch case _: IOException => None
