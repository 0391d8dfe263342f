package skein.ros

import java.nio.{ByteBuffer, ByteOrder}
import skein.airsim.WorldSettings
import skein.ros.message.{Header, Time}
import skein.units.*

class SensorMessagesSuite extends munit.FunSuite:
  private val header = Header(Time(1, 2), "a/front/optical")

  test("the matrix projects a point by the field of view, with pixels' middles at whole numbers"):
    val info = SensorMessages.cameraInfo(header, 64, 48, Radians(math.Pi / 2))
    val k    = info.k.values
    // 45° to the right is the edge of the last column, half a pixel beyond its middle.
    assertEqualsDouble(k(0) * 1 + k(2), 63.5, 1e-9)
    // As many pixels upwards as sideways for one angle.
    assertEqualsDouble(k(4) * -1 + k(5), 23.5 - 32, 1e-9)
    assertEquals(info.p.values.grouped(4).map(_.take(3).toVector).toVector.flatten, k.toVector)

  test("an optical frame looks along the camera's front, its y down"):
    val north =
      SensorMessages.optical(Instant.Epoch, "f", Vector3.Zero, Quaternion.Identity).transform.rotation
    val turn = Quaternion(north.w, north.x, north.y, north.z)
    // World axes are east, north, up; the camera heads north.
    def lies(optical: Vector3, enu: Vector3): Unit =
      val at = turn.toWorld(optical)
      for (one, other) <- Seq(at.x -> enu.x, at.y -> enu.y, at.z -> enu.z) do
        assertEqualsDouble(one, other, 1e-12)
    lies(Vector3(0, 0, 1), Vector3(0, 1, 0))
    lies(Vector3(0, 1, 0), Vector3(0, 0, -1))
    lies(Vector3(1, 0, 0), Vector3(1, 0, 0))

  test("points are three little-endian floats each"):
    val cloud = SensorMessages.points(header, 2)(number => Vector3(number, 10 + number, 20 + number))
    val bytes = ByteBuffer.wrap(cloud.data.toArray).order(ByteOrder.LITTLE_ENDIAN)
    assertEquals(Vector.fill(6)(bytes.getFloat), Vector(0f, 10f, 20f, 1f, 11f, 21f))
    assertEquals((cloud.width, cloud.rowStep, cloud.pointStep), (2, 24, 12))

  test("an image's rows have no gaps"):
    val image = SensorMessages.image(header, 4, 2, "bgr8", Array.ofDim[Byte](24))
    assertEquals((image.step, image.width, image.height), (12, 4, 2))

  test("sensors whose topics would be one are refused, and one that would take the body's frame"):
    def mistake(cameras: String, lidar: String) =
      val text = s"""{ "SettingsVersion": 1.2, "Vehicles": { "a": { "VehicleType": "SimpleFlight",
        "Cameras": { $cameras }, "Sensors": { "$lidar": { "SensorType": 6, "Enabled": true } } } } }"""
      val world = WorldSettings.parse(text).fold(error => fail(error.message), identity)
      SimulatedSensors.mistake(SimulatedSensors.Carried.of(world).head)
    assertEquals(mistake("\"front\": {}", "spin"), None)
    assert(mistake(
      "\"front cam\": {}, \"front_cam\": {}",
      "spin"
    ).exists(_.contains("'front cam', 'front_cam'")))
    assert(mistake("\"front\": {}", "front").isDefined)
    assert(mistake("\"front\": {}", "base_link").isDefined)

  test("names become parts of topics"):
    assertEquals(
      Seq("front", "0", "a b-ü").map(SensorMessages.token),
      Seq("front", "_0", "a_b__")
    )
