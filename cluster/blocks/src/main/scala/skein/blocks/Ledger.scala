package skein.blocks

import java.io.IOException
import java.nio.ByteBuffer
import java.nio.channels.FileChannel
import java.nio.file.{Files, Path, StandardOpenOption}
import java.util.zip.CRC32
import scala.collection.immutable.ArraySeq
import scala.collection.mutable
import scala.util.Using

/** The accepted answers on disk: the first one of each block. A restarted coordinator reads the ledger and
  * requests no answered block again. If the process dies, a record is either complete, or removed at the next
  * start.
  *
  * A damaged record is skipped, and its block computed again: reading goes on at the next place where length
  * and checksum agree.
  *
  * The file: 16 bytes of [[Ledger.Magic]], 32 bytes that identify the question, then records: length and
  * CRC-32 of what follows (4 bytes each, big-endian), the block's key (16 bytes), its answer. For one thread.
  *
  * @param index position and length of each block's answer
  * @param broken number of bytes of the opened file that belong to no complete record
  */
final class Ledger private (
    file: Path,
    channel: FileChannel,
    index: mutable.HashMap[BlockKey, (Long, Int)],
    private var end: Long,
    val broken: Long
) extends AutoCloseable:

  def size: Int = index.size

  def answer(key: BlockKey): Option[ArraySeq[Byte]] =
    index.get(key).map((at, length) => ArraySeq.unsafeWrapArray(Ledger.read(channel, at, length)))

  /** Writes an answer, unless its block has one already; returns whether the answer was written. */
  def accept(key: BlockKey, answer: ArraySeq[Byte]): Boolean =
    !index.contains(key) && {
      val record = Ledger.record(key, answer)
      // Removes a record that could not be written completely before the next.
      while record.hasRemaining do
        val _ = channel.write(record, end + record.position())
      index.update(key, (end + Ledger.Head + BlockKey.Bytes, answer.length))
      end += record.position()
      true
    }

  /** Returns once all accepted answers are on the disk. */
  def force(): Unit = channel.force(false)

  /** Closes the file; deletes it if it has no answer. */
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

  /** Maximum number of bytes read and summed to find records behind damage: about a second of work. */
  private val MostSought = 1L << 30

  /** Opens a question's ledger, or creates it.
    *
    * @param question 32 bytes that identify the question
    * @return Left says what prevents it: another question's ledger, or a file that cannot be written
    */
  def open(file: Path, question: ArraySeq[Byte]): Either[String, Ledger] =
    import StandardOpenOption.*
    require(question.length == Question, s"a question's name has $Question bytes, got ${question.length}")
    try
      val channel = FileChannel.open(file, CREATE, READ, WRITE)
      val size    = channel.size
      if size < First then
        // Nothing can follow an incomplete heading.
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
          Left(
            s"$file: the ledger of another question, or of another build of this program; expected that of " +
              "this question and build, or no file"
          )
        else
          val index = mutable.HashMap.empty[BlockKey, (Long, Int)]
          val found = scan(channel)((key, at, length) => { val _ = index.getOrElseUpdate(key, (at, length)) })
          val _     = channel.truncate(found.end)
          Right(Ledger(file, channel, index, found.end, found.broken))
    catch case failed: IOException => Left(s"cannot open the ledger $file: $failed")

  /** A ledger's content, read from the file only.
    *
    * @param blocks number of records with different keys
    * @param repeats number of records whose key occurred before; any such record is an error
    * @param broken number of bytes that belong to no complete record
    */
  final case class Audit(blocks: Int, repeats: Int, broken: Long)

  def audit(file: Path): Audit =
    Using.resource(FileChannel.open(file, StandardOpenOption.READ)): channel =>
      val keys    = mutable.HashSet.empty[BlockKey]
      var repeats = 0
      val found   = scan(channel)((key, _, _) => if !keys.add(key) then repeats += 1)
      Audit(keys.size, repeats, found.broken)

  /** @param end position after the last complete record
    * @param broken number of bytes between complete records and after the last
    */
  private final case class Scanned(end: Long, broken: Long)

  /** Passes every complete record to `tell`, in order; skips damaged ones. Searches behind damaged ones until
    * [[MostSought]] bytes are read.
    */
  private def scan(channel: FileChannel)(tell: (BlockKey, Long, Int) => Unit): Scanned =
    val size   = channel.size
    val search = Search(channel, size)
    var at     = First.toLong
    var end    = at
    var whole  = 0L
    while at < size do
      recordAt(channel, at, size) match
        case Some((Some(key), length)) =>
          tell(key, at + Head + BlockKey.Bytes, length - BlockKey.Bytes)
          at += Head + length
          end = at
          whole += Head + length
        case Some((None, length)) if isWhole(channel, at + Head + length, size) => at += Head + length
        case _ => at = search.from(at + 1).getOrElse(size)
    Scanned(end, size - First - whole)

  /** Length of the record at this position, with its key unless the checksum differs. */
  private def recordAt(channel: FileChannel, at: Long, size: Long): Option[(Option[BlockKey], Int)] =
    if size - at < Head + BlockKey.Bytes then None
    else
      val head   = ByteBuffer.wrap(read(channel, at, Head))
      val length = head.getInt
      val crc    = head.getInt
      if !isLength(length, size - at - Head) then None
      else
        val content = read(channel, at + Head, length)
        val key     = ByteBuffer.wrap(content)
        Some((Option.when(crcOf(content, 0, length) == crc)(BlockKey(key.getLong, key.getLong)), length))

  private def isWhole(channel: FileChannel, at: Long, size: Long) =
    recordAt(channel, at, size).exists(_._1.isDefined)

  private def isLength(length: Int, left: Long) =
    length >= BlockKey.Bytes && length <= Longest && length <= left

  /** Searches for records behind damage. Almost every byte may begin a record, by its length alone, so the
    * work has a limit for the whole file.
    */
  private final class Search(channel: FileChannel, size: Long):
    private var left = MostSought

    /** The first position from `at` on where length and checksum of a record agree. */
    def from(at: Long): Option[Long] =
      Iterator
        .iterate(at)(_ + Longest)
        .takeWhile(from => left > 0 && size - from >= Head + BlockKey.Bytes)
        .flatMap: from =>
          val bytes = ByteBuffer.wrap(read(channel, from, (size - from).min(2L * Longest + Head).toInt))
          left -= bytes.capacity
          (0 until Longest.min(bytes.capacity - Head - BlockKey.Bytes + 1)).iterator
            .filter(begins(bytes, _))
            .map(from + _)
        .nextOption()

    private def begins(bytes: ByteBuffer, at: Int): Boolean =
      val length = bytes.getInt(at)
      left > 0 && isLength(length, bytes.capacity.toLong - at - Head) && {
        left -= length
        crcOf(bytes.array, at + Head, length) == bytes.getInt(at + 4)
      }

  private def record(key: BlockKey, answer: ArraySeq[Byte]): ByteBuffer =
    val content = ByteBuffer.allocate(BlockKey.Bytes + answer.length)
    content.putLong(key.high).putLong(key.low).put(answer.toArray)
    ByteBuffer
      .allocate(Head + content.capacity)
      .putInt(content.capacity)
      .putInt(crcOf(content.array, 0, content.capacity))
      .put(content.array)
      .flip()

  private def crcOf(bytes: Array[Byte], from: Int, length: Int): Int =
    val crc = CRC32()
    crc.update(bytes, from, length)
    crc.getValue.toInt

  private def read(channel: FileChannel, at: Long, length: Int): Array[Byte] =
    val bytes = ByteBuffer.allocate(length)
    while bytes.hasRemaining && channel.read(bytes, at + bytes.position()) >= 0 do ()
    bytes.array
