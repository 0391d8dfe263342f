package skein.learn

import java.io.{DataInput, DataOutput, IOException}
import java.nio.ByteBuffer

/** The part of a checkpoint from which learning continues with identical bits. */
trait Saved:
  def save(out: DataOutput): Unit

  /** @throws IOException if the saved data have another shape */
  def load(in: DataInput): Unit

private[learn] object Saved:
  def write(out: DataOutput, numbers: Array[Float], count: Int): Unit =
    out.writeInt(count)
    val bytes = ByteBuffer.allocate(4 * count)
    bytes.asFloatBuffer.put(numbers, 0, count): Unit
    out.write(bytes.array)

  def write(out: DataOutput, numbers: Array[Float]): Unit = write(out, numbers, numbers.length)

  /** @return the number of values read */
  def readSome(in: DataInput, into: Array[Float]): Int =
    val count = in.readInt()
    if count < 0 || count > into.length then
      throw IOException(s"expected at most ${into.length} numbers, got $count")
    val bytes = Array.ofDim[Byte](4 * count)
    in.readFully(bytes)
    ByteBuffer.wrap(bytes).asFloatBuffer.get(into, 0, count): Unit
    count

  def read(in: DataInput, into: Array[Float]): Unit =
    val count = readSome(in, into)
    if count != into.length then throw IOException(s"expected ${into.length} numbers, got $count")
