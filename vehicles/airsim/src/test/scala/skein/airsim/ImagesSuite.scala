package skein.airsim

import skein.airsim.wire.{ImageResponse, LidarData, Pose, Quaternionr, Vector3r}
import skein.rpc.{MessageReader, Received, Wire}
import skein.units.*
import upack.*

class ImagesSuite extends munit.FunSuite:
  private val origin = Vector3(10, 20, -1)
  private val raw    = Shot("front_center")
  private val depth  = Shot("front_center", ImageKind.DepthPlanar, Encoding.Numbers)
  private val at     = Instant.ofNanos(123_456_789)

  private val image = ImageResponse(
    image_data_uint8 = Array.tabulate(4 * 2 * 3)(_.toByte),
    camera_position = Vector3r(1, 2, 3),
    camera_name = "front_center",
    camera_orientation = Quaternionr(0, 1, 0, 0),
    time_stamp = at,
    compress = false,
    width = 4,
    height = 2
  )

  private def received(bytes: Array[Byte]): Received = Received(bytes, 0)

  private def images(bytes: Array[Byte], shots: Shot*): Either[String, (Vector[Image], Instant)] =
    MessageReader.read(received(bytes))(Images.read(_, shots, origin)).flatMap(identity)

  private def scan(bytes: Array[Byte]): Either[String, (Scan, Instant)] =
    MessageReader.read(received(bytes))(Images.readScan(_, origin)).flatMap(identity)

  private def sent(images: ImageResponse*): Array[Byte] = ImageResponse.encode(images).bytes.toArray

  test("a received image has the sent pixels, and its camera's pose in the world"):
    val (read, exposed) = images(sent(image), raw).fold(fail(_), identity)
    assertEquals(exposed, at)
    assertEquals((read.head.width, read.head.height), (4, 2))
    assertEquals(read.head.positionNed, Vector3(11, 22, 2))
    assertEquals(read.head.orientation, Quaternion(0, 1, 0, 0))
    read.head.pixels match
      case Pixels.Bgr(bytes) => assertEquals(bytes.toArray.toSeq, image.image_data_uint8.toSeq)
      case other             => fail(s"$other")

  test("the images of one call are returned in the order of the shots"):
    val far = image.copy(
      image_data_uint8 = Array.emptyByteArray,
      image_data_float = Array.tabulate(8)(_ * 0.5f),
      pixels_as_float = true,
      image_type = 1
    )
    val (read, _) = images(sent(image, far), raw, depth).fold(fail(_), identity)
    read(1).pixels match
      case Pixels.Numbers(values) => assertEquals(values.toSeq, far.image_data_float.toSeq)
      case other                  => fail(s"$other")

  test("images are read with additional keys, in other orders, with missing keys, and from strings"):
    val cosys = Obj(
      Str("annotation_name")  -> Str(""),
      Str("height")           -> Int32(2),
      Str("width")            -> Int32(4),
      Str("image_data_uint8") -> Str("123456789012345678901234"),
      Str("image_data_float") -> Arr(Float32(0)),
      Str("camera_position")  -> Obj(Str("x_val") -> Int32(1), Str("further") -> Arr(Null))
    )
    val (read, exposed) = images(Wire.pack(Arr(cosys)), raw).fold(fail(_), identity)
    assertEquals(read.head.positionNed, Vector3(11, 20, -1))
    assertEquals(exposed, Instant.Epoch)

  test("an image that the simulator could not take is reported with its message"):
    val none = ImageResponse(image_data_uint8 = Array[Byte](0), message = "no such camera", compress = false)
    assertEquals(
      images(sent(none), raw),
      Left(
        "expected Scene of camera 'front_center' as Raw, got 0 × 0 pixels in 1 bytes and 0 numbers; " +
          "the simulator says: no such camera"
      )
    )
    assert(images(sent(image.copy(height = 3)), raw).isLeft)
    assert(images(sent(image.copy(width = -4, height = -2)), raw).isLeft)
    assertEquals(images(sent(image), raw, raw), Left("expected 2 images, got 1"))

  test("a scan is read as sent, a single value as an empty cloud, and mismatched ids are reported"):
    val cloud = LidarData(
      at,
      Array(1, 2, 3, 4, 5, 6),
      Pose(Vector3r(0, 0, -1), Quaternionr(1, 0, 0, 0)),
      Array(7, 8)
    )
    def bytes(scan: LidarData) = LidarData.encode(scan).bytes.toArray
    val (read, scanned)        = scan(bytes(cloud)).fold(fail(_), identity)
    assertEquals((read.points.toSeq, read.segmentation.toSeq), (cloud.point_cloud.toSeq, Seq(7, 8)))
    assertEquals((read.size, read.positionNed, scanned), (2, Vector3(10, 20, -2), at))
    assertEquals(
      scan(bytes(cloud.copy(point_cloud = Array(0), segmentation = Array(0)))).map(_._1.size),
      Right(0)
    )
    assertEquals(
      scan(bytes(cloud.copy(segmentation = Array(7)))),
      Left("expected 2 segmentation ids, got 1")
    )
    assertEquals(
      scan(bytes(cloud.copy(point_cloud = Array(1, 2)))),
      Left("expected x, y, z of each point, got 2 numbers")
    )
    val cosys = Obj(Str("point_cloud") -> Arr(), Str("groundtruth") -> Arr(Str("tree")))
    assertEquals(scan(Wire.pack(cosys)).map(_._1.size), Right(0))

  test("the nearest point by compass direction does not depend on the vehicle's heading"):
    // Two to the front of different depths, one to the right, one too far below.
    val points                        = Array[Float](8, 0, 0, 6, 0.1f, 1, 0, 5, 0, 0, -3, 2.5f)
    def near(orientation: Quaternion) = Scan(points, Array.empty, Vector3.Zero, orientation)
      .nearest(sectors = 4, bandM = 2, farM = 40)
      .toSeq
      .map(metres => math.round(metres * 100) / 100.0)
    assertEquals(near(Quaternion.Identity), Seq(6.0, 5.0, 40.0, 40.0))
    // Its front to the south-west: the points ahead lie there, those to the right to the north-west.
    val turned = StrictMath.toRadians(225) / 2
    assertEquals(
      near(Quaternion(StrictMath.cos(turned), 0, 0, StrictMath.sin(turned))),
      Seq(40.0, 40.0, 6.0, 5.0)
    )

  test("malformed replies throw nothing"):
    val figures = ImageFuzz.run(20_000, seed = 1)
    assert(figures.refused > 5_000 && figures.images > 500 && figures.scans > 500, figures)
