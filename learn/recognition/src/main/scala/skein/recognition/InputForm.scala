package skein.recognition

import java.nio.ByteBuffer
import skein.airsim.{Image, Pixels}
import skein.units.eachBelow

/** Converts an image to the tensor 1 × 3 × height × width that a model was trained on: the nearest pixel for
  * each element, (value − mean) · scale for each channel.
  *
  * @param redFirst whether red is the first channel; else blue is
  * @param mean mean of each channel in the model's order, from 0 to 255
  */
final case class InputForm(
    width: Int,
    height: Int,
    redFirst: Boolean = true,
    mean: (Float, Float, Float) = (0, 0, 0),
    scale: (Float, Float, Float) = (1 / 255f, 1 / 255f, 1 / 255f)
):
  require(width > 0 && height > 0, s"a model's image has pixels: $this")

  def tensor(image: Image): Either[String, Array[Float]] = image.pixels match
    case Pixels.Bgr(bytes) => tensor(image.width, image.height, bytes.buffer)
    case other             => Left(s"expected raw pixels, got ${other.productPrefix}")

  /** @param bgr blue, green, red of each pixel, in rows from the top
    */
  def tensor(imageWidth: Int, imageHeight: Int, bgr: ByteBuffer): Either[String, Array[Float]] =
    val expected = 3L * imageWidth * imageHeight
    if bgr.remaining != expected then
      Left(s"expected $expected bytes of $imageWidth × $imageHeight pixels, got ${bgr.remaining}")
    else
      val plane  = width * height
      val values = new Array[Float](3 * plane)
      val means  = Array(mean._1, mean._2, mean._3)
      val scales = Array(scale._1, scale._2, scale._3)
      for channel <- 0 until 3 do
        val byte = if redFirst then 2 - channel else channel
        eachBelow(height): y =>
          val row = (2L * y + 1) * imageHeight / (2L * height) * imageWidth
          eachBelow(width): x =>
            val column = (2L * x + 1) * imageWidth / (2L * width)
            val value  = bgr.get((3 * (row + column)).toInt + byte) & 0xff
            values(channel * plane + y * width + x) = (value - means(channel)) * scales(channel)
      Right(values)
