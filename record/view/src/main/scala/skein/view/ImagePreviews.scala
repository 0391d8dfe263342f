package skein.view

import java.awt.image.{BufferedImage, DataBufferByte}
import java.io.ByteArrayOutputStream
import java.nio.{ByteBuffer, ByteOrder}
import javax.imageio.stream.MemoryCacheImageOutputStream
import javax.imageio.{IIOImage, ImageIO, ImageWriteParam}
import scala.util.Using
import skein.record.{CameraImage, ImageEncoding}
import skein.units.Instant

/** Previews of images and clouds for viewers during a flight: JPEGs of up to [[ImagePreviews.MostWide]]
  * pixels a side, and a part of the points. The recording has the exact images and clouds.
  */
private[view] object ImagePreviews extends ImageEncoding:
  val MostWide    = 480
  val imageSchema = "foxglove.CompressedImage"
  val mostPoints  = 4096

  def image(image: CameraImage, at: Instant, frame: String): Array[Byte] =
    ImageEncoding.compressed(jpeg(small(image)), "jpeg", at, frame)

  /** A smaller image: each pixel is the mean of a square; depth as grey, black from [[FarM]] on. */
  private def small(image: CameraImage): BufferedImage =
    val (width, height) = (image.width.toInt, image.height.toInt)
    val by              = ((width.max(height) + MostWide - 1) / MostWide).max(1)
    val (wide, high)    = ((width / by).max(1), (height / by).max(1))
    val bytes           = image.pixels.bytes
    val small           = BufferedImage(wide, high, BufferedImage.TYPE_3BYTE_BGR)
    val target          = small.getRaster.getDataBuffer.asInstanceOf[DataBufferByte].getData
    if image.encoding == "bgr8" then
      if by == 1 then System.arraycopy(bytes, 0, target, 0, target.length)
      else shrink(bytes, width, by, target, wide, high)
    else
      val depths = ByteBuffer.wrap(bytes).order(ByteOrder.LITTLE_ENDIAN).asFloatBuffer
      var at     = 0
      while at < wide * high do
        val depth = depths.get(at / wide * by * width + at % wide * by)
        val grey  = (255 * (1 - (depth / FarM).max(0).min(1))).toByte
        target(at * 3) = grey
        target(at * 3 + 1) = grey
        target(at * 3 + 2) = grey
        at += 1
    small

  private def shrink(from: Array[Byte], width: Int, by: Int, to: Array[Byte], wide: Int, high: Int): Unit =
    val area = by * by
    var at   = 0
    while at < wide * high * 3 do
      val (column, row, colour) = (at / 3 % wide, at / 3 / wide, at % 3)
      var sum                   = 0
      var y                     = row * by
      while y < (row + 1) * by do
        var x = (y * width + column * by) * 3 + colour
        val e = x + by * 3
        while x < e do
          sum += from(x) & 0xff
          x += 3
        y += 1
      to(at) = (sum / area).toByte
      at += 1

  private def jpeg(image: BufferedImage): Array[Byte] =
    val writer = ImageIO.getImageWritersByFormatName("jpeg").next()
    val out    = ByteArrayOutputStream(32 * 1024)
    try
      Using.resource(MemoryCacheImageOutputStream(out)): stream =>
        writer.setOutput(stream)
        val how = writer.getDefaultWriteParam
        how.setCompressionMode(ImageWriteParam.MODE_EXPLICIT)
        how.setCompressionQuality(Quality)
        writer.write(null, IIOImage(image, null, null), how)
    finally writer.dispose()
    out.toByteArray

  private val FarM    = 50f
  private val Quality = 0.8f
