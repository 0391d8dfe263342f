package skein.ros

import java.nio.{ByteBuffer, ByteOrder}
import skein.airsim.{Image, Pixels, Scan, Shot, WorldSettings}
import skein.ros.message.{Header, PointCloud2, Time, TransformStamped}
import skein.rpc.Bytes
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

  private def image(pixels: Pixels) =
    SensorMessages.image(header, Image(Shot("front"), 4, 2, pixels, Vector3.Zero, Quaternion.Identity))

  test("an image's rows have no gaps"):
    val colours = image(Pixels.Bgr(Bytes(Array.ofDim[Byte](24), 0, 24))).get
    assertEquals((colours.step, colours.width, colours.height, colours.encoding), (12, 4, 2, "bgr8"))

  test("depths are floats in metres, and infinite where nothing is"):
    val depths = image(Pixels.Numbers(Array(0.5f, 65504f, 3, 4, 5, 6, 7, 8))).get
    val bytes  = ByteBuffer.wrap(depths.data.toArray).order(ByteOrder.LITTLE_ENDIAN)
    assertEquals((depths.step, depths.encoding), (16, "32FC1"))
    assertEquals(Vector.fill(3)(bytes.getFloat), Vector(0.5f, Float.PositiveInfinity, 3f))

  /** A vector in a transform's frame, in its parent's. */
  private def inWorld(of: TransformStamped, at: Vector3): Vector3 =
    val (turn, move) = (of.transform.rotation, of.transform.translation)
    Quaternion(turn.w, turn.x, turn.y, turn.z).toWorld(at) + Vector3(move.x, move.y, move.z)

  private def near(one: Vector3, other: Vector3): Unit =
    assertEqualsDouble((one - other).norm, 0, 1e-5, s"$one, $other")

  test("a lidar's points are where its frame in /tf puts them, and points of the world stay unchanged"):
    // It heads east, rolled by a quarter turn, so that its right points down.
    val pose  = Quaternion.ofYaw(math.Pi / 2) * Quaternion(math.sqrt(0.5), math.sqrt(0.5), 0, 0)
    val place = Vector3(3, -2, -5)
    val scan  = Scan(Array(30, 1, 0), Array.emptyIntArray, place, pose)
    val ned   = place + pose.toWorld(Vector3(30, 1, 0))
    near(ned, Vector3(3, 28, -4))
    def first(cloud: PointCloud2) =
      val bytes = ByteBuffer.wrap(cloud.data.toArray).order(ByteOrder.LITTLE_ENDIAN)
      Vector3(bytes.getFloat.toDouble, bytes.getFloat.toDouble, bytes.getFloat.toDouble)
    val (placed, cloud) =
      SensorMessages.scan(scan, Instant.Epoch, "a/spin", isLocal = true, startNed = Vector3(9, 9, 9))
    assertEquals((placed.get.header.frameId, placed.get.childFrameId), ("map", "a/spin"))
    assertEquals(cloud.header.frameId, "a/spin")
    near(inWorld(placed.get, first(cloud)), RosFrames.swapWorld(ned))
    val (none, world) = SensorMessages.scan(
      scan.copy(points = Array(1, 2, 3)),
      Instant.Epoch,
      "a/spin",
      isLocal = false,
      startNed = place
    )
    assertEquals((none, world.header.frameId), (None, "map"))
    near(first(world), RosFrames.swapWorld(Vector3(4, 0, -2)))

  test("a camera's frame in /tf and its matrix put a pixel where the camera sees it"):
    val (place, pose) = (Vector3(1, 2, -3), Quaternion.ofYaw(math.Pi / 2))
    val frame         = SensorMessages.optical(Instant.Epoch, "a/front/optical", place, pose)
    val k             = SensorMessages.cameraInfo(header, 64, 48, Radians(math.Pi / 2)).k.values
    // 10 m ahead, which is east; 2 m to the right, south; 1 m down.
    val (depth, right, down) = (10.0, 2.0, 1.0)
    val (u, v)               = (k(0) * right / depth + k(2), k(4) * down / depth + k(5))
    val optical              = Vector3((u - k(2)) / k(0), (v - k(5)) / k(4), 1) * depth
    near(inWorld(frame, optical), RosFrames.swapWorld(place + Vector3(-2, 10, 1)))

  test("sensors with coinciding topics are refused, and one that would take the body's frame"):
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

  test("a lidar of DefaultSensors has its frame, unless the vehicle has lidars of its own"):
    def local(own: String) =
      val text = s"""{ "SettingsVersion": 1.2,
        "DefaultSensors": { "spin": { "SensorType": 6, "Enabled": true, "DataFrame": "SensorLocalFrame" } },
        "Vehicles": { "a": { "VehicleType": "SimpleFlight", "Sensors": { $own } } } }"""
      val world = WorldSettings.parse(text).fold(error => fail(error.message), identity)
      SimulatedSensors.Carried.of(world).head.lidars.map(lidar => (lidar.name, lidar.isLocal))
    assertEquals(local(""), Vector(("spin", true)))
    assertEquals(local("\"mine\": { \"SensorType\": 6, \"Enabled\": true }"), Vector(("mine", false)))

  test("names are made valid in topics: other characters become _, which also precedes a leading digit"):
    assertEquals(
      Seq("front", "0", "a b-ü").map(SensorMessages.token),
      Seq("front", "_0", "a_b__")
    )
