package skein.mcap

import java.nio.{ByteBuffer, ByteOrder}

/** The checksum of LZ4 frames (https://github.com/Cyan4973/xxHash/blob/dev/doc/xxhash_spec.md), with seed 0.
  */
private[mcap] object XxHash32:
  private val P1 = 0x9e3779b1
  private val P2 = 0x85ebca77
  private val P3 = 0xc2b2ae3d
  private val P4 = 0x27d4eb2f
  private val P5 = 0x165667b1

  def of(array: Array[Byte], from: Int, until: Int): Int =
    val view = ByteBuffer.wrap(array).order(ByteOrder.LITTLE_ENDIAN)
    var at   = from
    var hash =
      if until - from < 16 then P5
      else
        var a = P1 + P2
        var b = P2
        var c = 0
        var d = -P1
        while until - at >= 16 do
          a = round(a, view.getInt(at))
          b = round(b, view.getInt(at + 4))
          c = round(c, view.getInt(at + 8))
          d = round(d, view.getInt(at + 12))
          at += 16
        Integer.rotateLeft(a, 1) + Integer.rotateLeft(b, 7) + Integer.rotateLeft(c, 12) +
          Integer.rotateLeft(d, 18)
    hash += until - from
    while until - at >= 4 do
      hash = Integer.rotateLeft(hash + view.getInt(at) * P3, 17) * P4
      at += 4
    while at < until do
      hash = Integer.rotateLeft(hash + (array(at) & 0xff) * P5, 11) * P1
      at += 1
    hash = (hash ^ (hash >>> 15)) * P2
    hash = (hash ^ (hash >>> 13)) * P3
    hash ^ (hash >>> 16)

  private def round(sum: Int, word: Int): Int = Integer.rotateLeft(sum + word * P2, 13) * P1
