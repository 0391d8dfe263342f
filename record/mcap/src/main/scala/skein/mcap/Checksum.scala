package skein.mcap

import java.util.zip.CRC32

/** CRC32 in the form of the specification, where 0 means that there is none. */
private[mcap] object Checksum:

  def of(array: Array[Byte], from: Int, until: Int): Int =
    val sum = CRC32()
    sum.update(array, from, until - from)
    sum.getValue.toInt

  def hold(written: Int, computed: Int, what: String, at: Place): Unit =
    if written != 0 && written != computed then throw Refused(McapError.WrongCrc(at, what, written, computed))
