package skein.airsim.wire

import org.msgpack.core.MessagePack
import org.msgpack.value.{MapValue, Value}
import scala.jdk.CollectionConverters.*
import skein.rpc.{Encoded, MessageWriter}
import skein.units.Instant
import upack.{Int32, Obj, Str, UInt64}
import upack.Binary
import upickle.default.{Writer, readBinary, writeMsg}

/** Reads Skein's encodings with an independent library. */
class WireSuite extends munit.FunSuite:

  /** A value's bytes in the server's encoding, after the reply's header of four bytes. */
  private def bytes[A: Writer](value: A): Array[Byte] =
    val writer = new MessageWriter
    writer.reply(0, Right(writeMsg(value)))
    writer.take().drop(4).toArray

  private def read[A: Writer](value: A): Map[String, Value] =
    fields(MessagePack.newDefaultUnpacker(bytes(value)).unpackValue())

  private def fields(value: Value): Map[String, Value] = value match
    case map: MapValue => map.map.asScala.map((key, field) => key.asStringValue.asString -> field).toMap
    case other         => fail(s"not a map: $other")

  private val vector     = Vector3r(1.5f, -2.25f, 1e-3f)
  private val rotation   = Quaternionr(1, 0, 0, 0)
  private val kinematics = KinematicsState(vector, rotation, vector, vector, vector, vector)
  private val at         = Instant.ofNanos(1_790_000_000_123_456_789L)
  private val state      =
    MultirotorState(
      CollisionInfo.None,
      kinematics,
      GeoPoint(47.641468, -122.140165, 122),
      at,
      1,
      RcData.Absent
    )

  test("kinematics are encoded with AirSim's keys and in AirSim's size"):
    assertEquals(
      read(kinematics).keySet,
      Set(
        "position",
        "orientation",
        "linear_velocity",
        "angular_velocity",
        "linear_acceleration",
        "angular_acceleration"
      )
    )
    assertEquals(fields(read(kinematics)("position")).keySet, Set("x_val", "y_val", "z_val"))
    val size = bytes(kinematics).length
    assert(size >= 256 && size <= 315, s"$size bytes")

  test("floats are 32-bit, latitude and longitude 64-bit, time stamps unsigned 64-bit"):
    val FLOAT32 = 0xca.toByte
    val FLOAT64 = 0xcb.toByte
    val UINT64  = 0xcf.toByte
    assertEquals(bytes(1.5f).head, FLOAT32)
    assertEquals(bytes(at).head, UINT64)
    val point = bytes(GeoPoint(1, 2, 3))
    assertEquals((point.count(_ == FLOAT64), point.count(_ == FLOAT32)), (2, 1))

  test("a multirotor state is encoded with AirSim's keys"):
    assertEquals(
      read(state).keySet,
      Set("collision", "kinematics_estimated", "gps_location", "timestamp", "landed_state", "rc_data")
    )
    assertEquals(read(state)("timestamp").asIntegerValue.asLong, at.toNanos)

  test("a client skips the additional keys of a state that forks send"):
    val sent = writeMsg(state).obj
    sent(Str("ready")) = upack.True
    assertEquals(readBinary[MultirotorReading](writeMsg(Obj(sent))), MultirotorReading(kinematics, at, 1))

  test("integers are accepted for floats and for time stamps"):
    assertEquals(
      readBinary[Vector3r](Obj(
        Str("x_val") -> Int32(1),
        Str("y_val") -> UInt64(2),
        Str("z_val") -> Int32(-3)
      )),
      Vector3r(1, 2, -3)
    )
    assertEquals(readBinary[Instant](Int32(5)), Instant.ofNanos(5))

  test("a yaw mode is written completely and read with missing or additional keys"):
    assertEquals(read(YawMode()).keySet, Set("is_rate", "yaw_or_rate"))
    assertEquals(
      readBinary[YawMode](Obj(Str("yaw_or_rate") -> Int32(90), Str("x") -> Int32(0))),
      YawMode(true, 90)
    )

  test("a name is read from str and from bin"):
    assertEquals(readBinary[Text](upack.Binary("Evader".getBytes)), Text("Evader"))

  private def sent(value: Encoded): Array[Byte] =
    val writer = new MessageWriter
    writer.reply(0, Right(value))
    writer.take().drop(4).toArray

  private val pixels = Array.tabulate[Byte](40_000)(i => (i * 7).toByte)
  private val images = Seq(
    ImageResponse(
      pixels,
      camera_name = "front_center",
      time_stamp = at,
      width = 100,
      height = 133,
      compress = false
    ),
    ImageResponse(image_data_float = Array(1.5f, 65504f, 0.1f), pixels_as_float = true, width = 3, height = 1)
  )

  test("images have AirSim's form: bytes as binary or floats as 32-bit floats, and the other empty"):
    val maps = MessagePack.newDefaultUnpacker(sent(ImageResponse.encode(images))).unpackValue().asArrayValue
    val rgb  = maps.get(0).asMapValue.entrySet.asScala.toSeq
    assertEquals(
      rgb.map(_.getKey.asStringValue.asString),
      Seq("image_data_uint8", "image_data_float", "camera_position", "camera_name", "camera_orientation") ++
        Seq("time_stamp", "message", "pixels_as_float", "compress", "width", "height", "image_type")
    )
    val first = fields(maps.get(0))
    assertEquals(first("image_data_uint8").asBinaryValue.asByteArray.toSeq, pixels.toSeq)
    assertEquals(first("image_data_float").asArrayValue.size, 0)
    assertEquals(first("time_stamp").asIntegerValue.asLong, at.toNanos)
    assertEquals(
      (first("width").asIntegerValue.asInt, first("compress").asBooleanValue.getBoolean),
      (100, false)
    )
    val second = fields(maps.get(1))
    assertEquals(second("image_data_uint8").asBinaryValue.asByteArray.length, 0)
    assertEquals(
      second("image_data_float").asArrayValue.asScala.map(_.asFloatValue.toFloat).toSeq,
      Seq(1.5f, 65504f, 0.1f)
    )

  test("Skein's client reads images and scans back, also with missing or additional keys"):
    val read = readBinary[Seq[ImageResponse]](sent(ImageResponse.encode(images)))
    assertEquals(read.map(_.image_data_uint8.toSeq), images.map(_.image_data_uint8.toSeq))
    assertEquals(read.map(_.image_data_float.toSeq), images.map(_.image_data_float.toSeq))
    assertEquals(read.map(_.camera_name), images.map(_.camera_name))
    val cosys = Obj(Str("groundtruth") -> upack.Arr(Str("Tree")), Str("point_cloud") -> upack.Arr(Int32(1)))
    assertEquals(readBinary[LidarData](cosys).point_cloud.toSeq, Seq(1f))
    assertEquals(readBinary[ImageResponse](Obj(Str("image_data_uint8") -> Binary(pixels))).width, 0)

  test("a scan is encoded with AirSim's keys and one id for each point"):
    val scan = LidarData(at, Array(1f, -2f, 3f), Pose(vector, rotation), Array(42))
    val keys = fields(MessagePack.newDefaultUnpacker(sent(LidarData.encode(scan))).unpackValue())
    assertEquals(keys.keySet, Set("time_stamp", "point_cloud", "pose", "segmentation"))
    val back = readBinary[LidarData](sent(LidarData.encode(scan)))
    assertEquals((back.time_stamp, back.pose), (scan.time_stamp, scan.pose))
    assertEquals((back.point_cloud.toSeq, back.segmentation.toSeq), (Seq(1f, -2f, 3f), Seq(42)))

  test("an image is sent from its own array, without a copy"):
    val drawn   = pixels.clone
    val encoded = ImageResponse.encode(Seq(ImageResponse(drawn, width = 100, height = 133))).bytes
    drawn(20_000) = 99
    assert(encoded.toArray.containsSlice(drawn.slice(19_990, 20_010)))
