package skein.settings

import java.nio.ByteBuffer
import java.util.Base64
import scala.util.Try

/** Floating-point values as text, to the bit: doubles, big-endian, in Base64. */
private object Numbers64:
  def text(numbers: Vector[Double]): String =
    val bytes = ByteBuffer.allocate(8 * numbers.size)
    numbers.foreach(number => bytes.putDouble(number))
    Base64.getEncoder.encodeToString(bytes.array)

  def parse(text: String): Option[Vector[Double]] =
    Try(Base64.getDecoder.decode(text)).toOption
      .filter(_.length % 8 == 0)
      .map: bytes =>
        val numbers = ByteBuffer.wrap(bytes)
        Vector.fill(bytes.length / 8)(numbers.getDouble)
