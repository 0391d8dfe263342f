package skein.blocks

import java.io.IOException
import java.nio.ByteBuffer
import java.nio.channels.FileChannel
import java.nio.file.{Files, Path, StandardOpenOption}
import java.util.zip.CRC32
import scala.collection.immutable.ArraySeq
import scala.collection.mutable
import scala.util.Using

/** The answers that count, on disk: each block's first one, once. A coordinator that is started again reads
  * it and asks for nothing twice. Whatever ends the process, a record is there whole or is cut off at the
  * next start.
  *
  * A record that was damaged since is passed over, and its block computed again.
  *
  * The file: 16 bytes of [[Ledger.Magic]], 32 bytes that name the question, then records: length and CRC-32
  * of what follows (4 bytes each, big-endian), the block's key (16 bytes), its answer. For one thread.
  *
  * @param index where each block's answer stands, and how long it is
  * @param broken bytes of the file, as it was opened, that belong to no whole record
  */
final class Ledger private (
    file: Path,
    channel: FileChannel,
    index: mutable.HashMap[BlockKey, (Long, Int)],
    private var end: Long,
    val broken: Long
) extends AutoCloseable:

  def size: Int = index.size

  def bytes: Long = end

  def answer(key: BlockKey): Option[ArraySeq[Byte]] =
    index.get(key).map: (at, length) =>
      val bytes = ByteBuffer.allocate(length)
      while bytes.hasRemaining && channel.read(bytes, at + bytes.position()) >= 0 do ()
      ArraySeq.unsafeWrapArray(bytes.array)

  /** @return whether the answer is the block's first and was written
    */
  def accept(key: BlockKey, answer: ArraySeq[Byte]): Boolean =
    !index.contains(key) && {
      val record = Ledger.record(key, answer)
      // Of a record that could not be written whole nothing is left before the next.
      while record.hasRemaining do
        val _ = channel.write(record, end + record.position())
      index.update(key, (end + Ledger.Head + BlockKey.Bytes, answer.length))
      end += record.position()
      true
    }

  /** All that was accepted is on the disk when this returns. */
  def force(): Unit = channel.force(false)

  /** Of one without an answer no file is left. */
  def close(): Unit = if channel.isOpen then
    force()
    channel.close()
    if index.isEmpty then Files.deleteIfExists(file): Unit

object Ledger:
  val Name             = "blocks.ledger"
  private val Magic    = "skein-blocks-001".getBytes("US-ASCII")
  private val Head     = 8
  private val Question = 32
  private val First    = Magic.length + Question
  private val Longest  = 16 << 20

  /** Opens the ledger of a question, or begins it.
    *
    * @param question 32 bytes that name it
    * @return or why not: another question's ledger, or a file that cannot be written
    */
  def open(file: Path, question: ArraySeq[Byte]): Either[String, Ledger] =
    import StandardOpenOption.*
    require(question.length == Question, s"a question's name has $Question bytes, came ${question.length}")
    try
      val channel = FileChannel.open(file, CREATE, READ, WRITE)
      val size    = channel.size
      if size < First then
        // Nothing can stand behind half a heading.
        val _       = channel.truncate(0)
        val heading = ByteBuffer.wrap(Magic ++ question.toArray)
        while heading.hasRemaining do { val _ = channel.write(heading) }
        Right(Ledger(file, channel, mutable.HashMap.empty, First, size))
      else
        val heading = read(channel, 0, First)
        if !heading.take(Magic.length).sameElements(Magic) then
          channel.close()
          Left(s"$file: expected a ledger of blocks, which begins with '${String(Magic, "US-ASCII")}'")
        else if !heading.drop(Magic.length).sameElements(question.toArray) then
          channel.close()
          Left(s"$file: the ledger of another question; expected that of this one, or no file")
        else
          val index = mutable.HashMap.empty[BlockKey, (Long, Int)]
          val found = scan(channel)((key, at, length) => { val _ = index.getOrElseUpdate(key, (at, length)) })
          val _     = channel.truncate(found.end)
          Right(Ledger(file, channel, index, found.end, found.broken))
    catch case failed: IOException => Left(s"cannot open the ledger $file: $failed")

  /** What a ledger holds, read from the file alone.
    *
    * @param blocks records with different keys
    * @param repeats records whose key came before; none, or something is wrong
    * @param broken bytes that belong to no whole record
    */
  final case class Audit(blocks: Int, repeats: Int, broken: Long)

  def audit(file: Path): Audit =
    Using.resource(FileChannel.open(file, StandardOpenOption.READ)): channel =>
      val keys    = mutable.HashSet.empty[BlockKey]
      var repeats = 0
      val found   = scan(channel)((key, _, _) => if !keys.add(key) then repeats += 1)
      Audit(keys.size, repeats, found.broken)

  /** @param end behind the last whole record
    * @param broken bytes between whole records and behind the last
    */
  private final case class Scanned(end: Long, broken: Long)

  /** Passes every whole record to `tell`, in order; skips damaged ones. */
  private def scan(channel: FileChannel)(tell: (BlockKey, Long, Int) => Unit): Scanned =
    val size  = channel.size
    var at    = First.toLong
    var end   = at
    var whole = 0L
    var next  = recordAt(channel, at, size)
    while next.isDefined do
      val (key, length) = next.get
      val from          = at
      at += Head + length
      key.foreach: key =>
        tell(key, from + Head + BlockKey.Bytes, length - BlockKey.Bytes)
        end = at
        whole += Head + length
      next = recordAt(channel, at, size)
    Scanned(end, size - First - whole)

  /** How long the record is that stands there, and its key unless its checksum is another. */
  private def recordAt(channel: FileChannel, at: Long, size: Long): Option[(Option[BlockKey], Int)] =
    if size - at < Head + BlockKey.Bytes then None
    else
      val head   = ByteBuffer.wrap(read(channel, at, Head))
      val length = head.getInt
      val crc    = head.getInt
      if length < BlockKey.Bytes || length > Longest || size - at - Head < length then None
      else
        val content = read(channel, at + Head, length)
        val key     = ByteBuffer.wrap(content)
        Some((Option.when(crcOf(content) == crc)(BlockKey(key.getLong, key.getLong)), length))

  private def record(key: BlockKey, answer: ArraySeq[Byte]): ByteBuffer =
    val content = ByteBuffer.allocate(BlockKey.Bytes + answer.length)
    content.putLong(key.high).putLong(key.low).put(answer.toArray)
    ByteBuffer
      .allocate(Head + content.capacity)
      .putInt(content.capacity)
      .putInt(crcOf(content.array))
      .put(content.array)
      .flip()

  private def crcOf(bytes: Array[Byte]): Int =
    val crc = CRC32()
    crc.update(bytes)
    crc.getValue.toInt

  private def read(channel: FileChannel, at: Long, length: Int): Array[Byte] =
    val bytes = ByteBuffer.allocate(length)
    while bytes.hasRemaining && channel.read(bytes, at + bytes.position()) >= 0 do ()
    bytes.array
