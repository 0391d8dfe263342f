package skein.airsim.wire

import org.msgpack.core.MessagePack
import org.msgpack.value.{MapValue, Value}
import scala.jdk.CollectionConverters.*
import skein.rpc.MessageWriter
import skein.units.Instant
import upack.{Int32, Obj, Str, UInt64}
import upickle.default.{Writer, readBinary, writeMsg}

/** Our bytes, read by another library. */
class WireSuite extends munit.FunSuite:

  /** As the server writes it: behind the reply's header of four bytes. */
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

  test("kinematics have AirSim's keys and AirSim's size"):
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

  test("a multirotor state has AirSim's keys"):
    assertEquals(
      read(state).keySet,
      Set("collision", "kinematics_estimated", "gps_location", "timestamp", "landed_state", "rc_data")
    )
    assertEquals(read(state)("timestamp").asIntegerValue.asLong, at.toNanos)

  test("a client reads what it needs of a state and passes over the rest, as forks send more"):
    val sent = writeMsg(state).obj
    sent(Str("ready")) = upack.True
    assertEquals(readBinary[MultirotorReading](writeMsg(Obj(sent))), MultirotorReading(kinematics, at, 1))

  test("integers are read where floats are wanted, also as time stamps"):
    assertEquals(
      readBinary[Vector3r](Obj(
        Str("x_val") -> Int32(1),
        Str("y_val") -> UInt64(2),
        Str("z_val") -> Int32(-3)
      )),
      Vector3r(1, 2, -3)
    )
    assertEquals(readBinary[Instant](Int32(5)), Instant.ofNanos(5))

  test("a yaw mode is written whole and read with missing or more keys"):
    assertEquals(read(YawMode()).keySet, Set("is_rate", "yaw_or_rate"))
    assertEquals(
      readBinary[YawMode](Obj(Str("yaw_or_rate") -> Int32(90), Str("x") -> Int32(0))),
      YawMode(true, 90)
    )

  test("a name is read from str and from bin"):
    assertEquals(readBinary[Text](upack.Binary("Evader".getBytes)), Text("Evader"))
