package skein.airsim

import scala.util.Random
import skein.airsim.wire.{ImageResponse, LidarData, Quaternionr, Vector3r}
import skein.rpc.{MessageReader, Mutation, Received}
import skein.units.*

/** Replies with images and scans, changed in a few places: each is read as a valid value, or refused; nothing
  * is thrown.
  */
object ImageFuzz:

  /** Counts of the replies by their results. */
  final case class Figures(replies: Int, images: Int, scans: Int, refused: Int)

  def run(replies: Int, seed: Long): Figures =
    var images, scans, refused = 0
    for number <- 0 until replies do
      val random = Random(seed + number)
      try
        if random.nextBoolean() then
          val shots = Seq(Shot("0"), Shot("0", ImageKind.DepthPlanar, Encoding.Numbers))
          read(changed(Sent, random))(Images.read(_, shots, Vector3.Zero)) match
            case Right((found, _)) =>
              require(found.forall(isWhole), s"$found")
              images += 1
            case Left(_) => refused += 1
        else
          read(changed(Cloud, random))(Images.readScan(_, Vector3.Zero)) match
            case Right((scan, _)) =>
              require(scan.segmentation.isEmpty || scan.segmentation.length == scan.size, s"$scan")
              scans += 1
            case Left(_) => refused += 1
      catch case error: Throwable => throw AssertionError(s"seed ${seed + number}", error)
    Figures(replies, images, scans, refused)

  private def changed(reply: Array[Byte], random: Random): Array[Byte] =
    (0 to random.nextInt(3)).foldLeft(reply)((bytes, _) => Mutation.mutated(bytes, random))

  private def read[A](bytes: Array[Byte])(in: MessageReader => Either[String, A]): Either[String, A] =
    MessageReader.read(Received(bytes, 0))(in).flatMap(identity)

  private def isWhole(image: Image): Boolean = image.pixels match
    case Pixels.Bgr(bytes)      => bytes.length == 3 * image.width * image.height
    case Pixels.Numbers(values) => values.length == image.width * image.height
    case Pixels.Png(_)          => false

  private val Sent =
    val raw = ImageResponse(
      image_data_uint8 = Array.tabulate(4 * 2 * 3)(_.toByte),
      camera_position = Vector3r(1, 2, 3),
      camera_name = "0",
      camera_orientation = Quaternionr(0, 1, 0, 0),
      time_stamp = Instant.ofNanos(123_456_789),
      compress = false,
      width = 4,
      height = 2
    )
    val depth = raw.copy(
      image_data_uint8 = Array.emptyByteArray,
      image_data_float = Array.tabulate(8)(_ * 0.5f),
      pixels_as_float = true,
      image_type = 1
    )
    ImageResponse.encode(Seq(raw, depth)).bytes.toArray

  private val Cloud = LidarData
    .encode(LidarData(Instant.ofNanos(5), Array.fill(30)(1f), segmentation = Array.fill(10)(1)))
    .bytes
    .toArray
