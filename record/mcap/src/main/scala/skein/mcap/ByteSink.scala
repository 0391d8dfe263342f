package skein.mcap

/** Takes what a writer writes, in order. */
trait ByteSink:

  /** `array[from, until)`, which it must have used up when it returns. */
  def write(array: Array[Byte], from: Int, until: Int): Unit

/** Gives what a reader asks for. */
trait ByteSource:

  /** Of the whole, in bytes. */
  def size: Long

  /** `length` bytes from `offset` on, all of them within `size`. */
  def read(offset: Long, length: Int): Bytes

object ByteSource:
  /** A file that lies in memory. */
  def of(bytes: Bytes): ByteSource = new ByteSource:
    def size: Long                             = bytes.size
    def read(offset: Long, length: Int): Bytes = bytes.slice(offset.toInt, offset.toInt + length)
