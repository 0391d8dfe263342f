package skein.record

import java.nio.ByteBuffer
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.Path
import java.security.MessageDigest
import java.util.HexFormat

/** A hash of a recording's content, in 64 hexadecimal digits: equal for equal contents, whatever the bytes of
  * the file.
  *
  * It is the SHA-256 over all rows in the order of their row numbers. Each is hashed as the name of its
  * table, its row number, and its columns from left to right; a value as one byte for its kind (0 absent, 1
  * text, 2 BIGINT, 3 DOUBLE, 4 BLOB) and then eight bytes, big-endian: the integer, the bits of the double,
  * or the length of the text's UTF-8 or of the BLOB's bytes, uncompressed, that follow. A list of integers
  * counts as their text with commas between, any other list as its length and its values. An absent value of
  * a column of format 5 or later is left out. How the flight ended ([[Ending]], the last row) is left out:
  * formats before 4 did not record it.
  */
final case class Digest(hex: String):
  override def toString: String = hex

object Digest:

  /** The digest of records in the order in which they were accepted. */
  def of(records: Iterator[Record]): Digest =
    val row = DigestRow()
    for (record, number) <- records.zipWithIndex if !isEnding(record) do row.add(number, record)
    row.digest

  /** The digest of a file. Blocks; holds the whole recording in memory. */
  def ofFile(file: Path): Either[RecordError, Digest] =
    RecordingReader
      .records(file)
      .map: rows =>
        val row = DigestRow()
        for (number, record) <- rows if !isEnding(record) do row.add(number, record)
        row.digest

  private def isEnding(record: Record): Boolean = record.isInstanceOf[Ending]

  private final class DigestRow extends RowWriter:
    private val sha256 = MessageDigest.getInstance("SHA-256")
    private val bytes  = ByteBuffer.allocate(9)

    def add(number: Long, record: Record): Unit =
      text(Table.of(record).name)
      long(number)
      Table.columnsOf(record).append(record, this)

    def digest: Digest = Digest(HexFormat.of.formatHex(sha256.digest()))

    def text(value: String): Unit =
      val utf8 = value.getBytes(UTF_8)
      put(1, utf8.length)
      sha256.update(utf8)

    def long(value: Long): Unit               = put(2, value)
    def double(value: Double): Unit           = put(3, java.lang.Double.doubleToLongBits(value))
    def longs(values: Vector[Long]): Unit     = text(values.mkString(","))
    def doubles(values: Vector[Double]): Unit =
      long(values.size)
      values.foreach(double)
    def texts(values: Vector[String]): Unit =
      long(values.size)
      values.foreach(text)
    def blob(value: Blob): Unit =
      val bytes = value.bytes
      put(4, bytes.length)
      sha256.update(bytes)
    def nothing(): Unit             = put(0, 0)
    override def nothingYet(): Unit = ()

    private def put(kind: Byte, value: Long): Unit =
      sha256.update(bytes.clear().put(kind).putLong(value).flip())
