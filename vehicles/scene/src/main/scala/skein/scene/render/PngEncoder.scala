package skein.scene.render

import java.io.ByteArrayOutputStream
import java.nio.ByteBuffer
import java.util.Arrays
import java.util.zip.CRC32

/** PNG files of images of few colours, fast, with identical bytes on every machine: each pixel minus the one
  * above it, in one deflate block of fixed codes whose only matches are runs. Pixels equal to the row above,
  * most of a drawn image, are found by comparing arrays.
  */
object PngEncoder:

  /** @param bgr three bytes per pixel: blue, green, red; rows from the top */
  def encode(bgr: Array[Byte], width: Int, height: Int): Array[Byte] =
    require(bgr.length == width * height * 3, s"${bgr.length} bytes for $width × $height pixels")
    val out = ByteArrayOutputStream(bgr.length / 16 + 256)
    out.write(Signature)
    chunk(
      out,
      "IHDR",
      ByteBuffer.allocate(13).putInt(width).putInt(height).put(Array[Byte](8, 2, 0, 0, 0)).array
    )
    chunk(out, "IDAT", new Stream(bgr, width, height).compress())
    chunk(out, "IEND", Array.emptyByteArray)
    out.toByteArray

  private val Signature = Array(0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a).map(_.toByte)

  private def chunk(out: ByteArrayOutputStream, name: String, content: Array[Byte]): Unit =
    val tag = name.getBytes("US-ASCII")
    val crc = CRC32()
    crc.update(tag)
    crc.update(content)
    out.write(ByteBuffer.allocate(4).putInt(content.length).array)
    out.write(tag)
    out.write(content)
    out.write(ByteBuffer.allocate(4).putInt(crc.getValue.toInt).array)

  /** The zlib stream of an image (RFC 1950, RFC 1951). */
  final private class Stream(bgr: Array[Byte], width: Int, height: Int):
    private var bytes = new Array[Byte](bgr.length / 16 + 1024)
    private var used  = 0
    private var bits  = 0L
    private var held  = 0

    // Adler-32's sums.
    private var sum1 = 1L
    private var sum2 = 0L

    def compress(): Array[Byte] =
      put(0x78, 8)
      put(0x01, 8)
      put(3, 3) // the last block, of fixed codes
      val above = new Array[Byte](width * 3)
      var row   = 0
      while row < height do
        literal(UpFilter)
        if row == 0 then line(0, above, 0) else line(row * width * 3, bgr, (row - 1) * width * 3)
        row += 1
      put(0, 7) // its end
      if held % 8 != 0 then put(0, 8 - held % 8)
      for shift <- Seq(24, 16, 8, 0) do put(((sum2 << 16 | sum1) >> shift).toInt & 0xff, 8)
      flush()
      Arrays.copyOf(bytes, used)

    private def line(from: Int, above: Array[Byte], aboveFrom: Int): Unit =
      val length = width * 3
      var at     = 0
      while at < length do
        val differs =
          Arrays.mismatch(bgr, from + at, from + length, above, aboveFrom + at, aboveFrom + length)
        val same = if differs < 0 then length - at else differs - differs % 3
        if same > 0 then
          zeros(same)
          at += same
        else
          val (b, g, r) = delta(from + at, above, aboveFrom + at)
          literal(r)
          literal(g)
          literal(b)
          at += 3
          val first = at
          while at < length && delta(from + at, above, aboveFrom + at) == (b, g, r) do at += 3
          if at > first then
            for _ <- first until at by 3 do
              sum(r)
              sum(g)
              sum(b)
            repeat(at - first, distance = 3)

    private inline def delta(at: Int, above: Array[Byte], aboveAt: Int): (Int, Int, Int) = (
      (bgr(at) - above(aboveAt)) & 0xff,
      (bgr(at + 1) - above(aboveAt + 1)) & 0xff,
      (bgr(at + 2) - above(aboveAt + 2)) & 0xff
    )

    private def literal(value: Int): Unit =
      sum(value)
      put(LiteralCodes(value), LiteralBits(value))

    private def sum(value: Int): Unit =
      sum1 = (sum1 + value) % Adler
      sum2 = (sum2 + sum1)  % Adler

    private def zeros(count: Int): Unit =
      literal(0)
      sum2 = (sum2 + (count - 1) * sum1) % Adler
      repeat(count - 1, distance = 1)

    /** Writes a copy of `count` bytes from `distance` bytes back, 1 or 3. Fewer than 3 bytes are written as
      * literals.
      */
    private def repeat(count: Int, distance: Int): Unit =
      var left = count
      while left > 0 do
        // No rest of 1 or 2 may be left.
        val length = if left <= LongestMatch then left else math.min(LongestMatch, left - ShortestMatch)
        if length < ShortestMatch then
          for _ <- 0 until length do put(LiteralCodes(0), LiteralBits(0))
        else
          val code = LengthCodeOf(length)
          put(LiteralCodes(FirstLengthCode + code), LiteralBits(FirstLengthCode + code))
          put(length - LengthBase(code), LengthExtra(code))
          // Distance codes have five bits, the highest first: 1 is code 0, 3 is code 2.
          put(if distance == 1 then 0 else 8, 5)
        left -= length

    /** Writes the lowest `count` bits of `value`, lowest bit first. */
    private def put(value: Int, count: Int): Unit =
      bits |= value.toLong << held
      held += count
      if held >= 32 then flush()

    private def flush(): Unit =
      if used + 8 > bytes.length then bytes = Arrays.copyOf(bytes, 2 * bytes.length)
      while held >= 8 do
        bytes(used) = bits.toByte
        used += 1
        bits >>>= 8
        held -= 8

  private val UpFilter        = 2
  private val Adler           = 65521L
  private val ShortestMatch   = 3
  private val LongestMatch    = 258
  private val FirstLengthCode = 257

  private val LengthExtra =
    Array(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0)
  private val LengthBase =
    LengthExtra.dropRight(2).scanLeft(ShortestMatch)((base, extra) => base + (1 << extra)) :+ LongestMatch
  private val LengthCodeOf =
    Array.tabulate(LongestMatch + 1)(length => LengthBase.lastIndexWhere(_ <= length))

  /** Code lengths of RFC 1951, 3.2.6; codes are written with their highest bit first. */
  private val LiteralBits =
    Array.tabulate(288)(i => if i < 144 then 8 else if i < 256 then 9 else if i < 280 then 7 else 8)
  private val LiteralCodes = Array.tabulate(288): i =>
    val code =
      if i < 144 then 0x30 + i
      else if i < 256 then 0x190 + i - 144 else if i < 280 then i - 256 else 0xc0 + i - 280
    Integer.reverse(code) >>> (32 - LiteralBits(i))
