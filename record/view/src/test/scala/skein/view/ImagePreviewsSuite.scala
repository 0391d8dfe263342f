package skein.view

import java.awt.image.BufferedImage
import java.io.ByteArrayInputStream
import java.nio.{ByteBuffer, ByteOrder}
import javax.imageio.ImageIO
import skein.record.{Blob, Samples}
import skein.units.Instant

class ImagePreviewsSuite extends munit.FunSuite:
  import ImagePreviewsSuite.jpeg

  private def shown(width: Int, height: Int, encoding: String, bytes: Array[Byte]) = jpeg(ImagePreviews.image(
    Samples.image(1).copy(width = width, height = height, encoding = encoding, pixels = Blob.of(bytes)),
    Instant.ofNanos(1_500_000_000L),
    "camera"
  ))

  private def near(rgb: Int, r: Int, g: Int, b: Int): Unit =
    val off = Seq(16 -> r, 8 -> g, 0 -> b).map((shift, wanted) => ((rgb >> shift & 0xff) - wanted).abs).max
    assert(off < 12, f"$rgb%x, expected $r $g $b")

  test("a large image is shrunk by a whole factor, and its colours keep their positions"):
    val (width, height) = (1280, 720)
    // Blue on the left, red on the right.
    val bytes = Array.tabulate(width * height * 3): at =>
      val left = at / 3 % width < width / 2
      (if at % 3 == 0 && left || at % 3 == 2 && !left then 255 else 0).toByte
    val small = shown(width, height, "bgr8", bytes)
    assertEquals((small.getWidth, small.getHeight), (426, 240))
    near(small.getRGB(20, 100), 0, 0, 255)
    near(small.getRGB(400, 100), 255, 0, 0)

  test("depths are grey: white for near, black for far or infinite depths"):
    val depths = ByteBuffer.allocate(64 * 32 * 4).order(ByteOrder.LITTLE_ENDIAN)
    for at <- 0 until 64 * 32 do
      depths.putFloat(if at % 64 < 16 then 0 else if at % 64 < 32 then 25 else Float.PositiveInfinity): Unit
    val small = shown(64, 32, "32FC1", depths.array)
    near(small.getRGB(4, 16), 255, 255, 255)
    near(small.getRGB(24, 16), 128, 128, 128)
    near(small.getRGB(50, 16), 0, 0, 0)

object ImagePreviewsSuite:
  /** The JPEG in a `foxglove.CompressedImage`, from its first bytes on. */
  def jpeg(message: Array[Byte]): BufferedImage =
    val from =
      message.indices.find(at => (message(at) & 0xff) == 0xff && (message(at + 1) & 0xff) == 0xd8).get
    ImageIO.read(ByteArrayInputStream(message.drop(from)))
