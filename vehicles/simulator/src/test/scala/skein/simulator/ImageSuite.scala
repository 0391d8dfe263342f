package skein.simulator

import java.io.ByteArrayInputStream
import javax.imageio.ImageIO
import skein.airsim.{ImageKind, VehicleSettings, WorldSettings}
import skein.airsim.wire.*
import skein.scene.SceneFile
import skein.scene.render.Palette
import skein.units.*
import upack.*
import upickle.default.writeMsg

/** Readings of cameras, lidars and distance sensors in a scene, and the scene's contacts with vehicles. */
class ImageSuite extends munit.FunSuite:
  private val scene = SceneFile
    .parse("""objects = [{ name = House, box = [2, 8, 6], at = [11, 0], id = 42 }]""", "a")
    .fold(error => fail(error.message), identity)

  private val carrying =
    """{"Vehicles": {"A": {
      |    "Cameras": {"nose": {"X": 0.5, "Pitch": -90, "CaptureSettings": [{"ImageType": 0, "Width": 64, "Height": 32, "FOV_Degrees": 60}]}},
      |    "Sensors": {"Lidar": {"SensorType": 6, "Enabled": true, "VerticalFOVUpper": 30, "VerticalFOVLower": -30},
      |      "Own": {"SensorType": 6, "Enabled": true, "DataFrame": "SensorLocalFrame", "Fresh": true, "PointsPerSecond": 5000},
      |      "Front": {"SensorType": 5, "Enabled": true}}}, "B": {"X": 5, "Y": 0, "Z": 0}},
      |  "CameraDefaults": {"CaptureSettings": [{"ImageType": 5, "Width": 100, "Height": 60}]}}""".stripMargin

  private def bench() =
    val vehicles = WorldSettings.parse(carrying).fold(error => fail(error.message), _.vehicles)
    val made     = Bench(settings = vehicles, scene = scene, text = carrying)
    made.tell("simPause", Bool(true))
    made

  private def place(bench: Bench, vehicle: String, at: Vector3): Unit =
    bench.tell(
      "simSetVehiclePose",
      writeMsg(Pose(Vector3r(at), Quaternionr(1, 0, 0, 0))),
      Bool(true),
      Str(vehicle)
    )

  private def shoot(bench: Bench, requests: ImageRequest*): Seq[ImageResponse] =
    bench.now[Seq[ImageResponse]]("simGetImages", Arr(requests.map(writeMsg(_))*), Str("A"), Bool(false))

  private def request(kind: ImageKind, floats: Boolean = false, camera: String = "0") =
    ImageRequest(camera, kind.ordinal, floats, compress = false)

  test("images of one call are of one instant, in AirSim's sizes, and show the scene before the camera"):
    val bench = this.bench()
    place(bench, "A", Vector3(0, 0, -3))
    place(bench, "B", Vector3(0, 50, -3))
    val Seq(rgb, depth, ids) =
      shoot(
        bench,
        request(ImageKind.Scene),
        request(ImageKind.DepthPlanar, floats = true),
        request(ImageKind.Segmentation)
      ): @unchecked
    assertEquals((rgb.width, rgb.height, rgb.image_data_uint8.length), (256, 144, 256 * 144 * 3))
    assertEquals((ids.width, ids.height), (100, 60))
    assertEquals(Set(rgb, depth, ids).map(_.time_stamp), Set(bench.simulation.world.now))
    // The house's front is 10 m north of the vehicle, whose front camera is 25 cm ahead of its centre.
    assertEqualsFloat(depth.image_data_float(72 * 256 + 128), 9.75f, 1e-3f)
    assertEquals(depth.image_data_uint8.length, 0)
    val middle = 3 * (30 * 100 + 50)
    val colour = ids.image_data_uint8.slice(middle, middle + 3).map(_ & 0xff)
    assertEquals(colour(2) << 16 | colour(1) << 8 | colour(0), Palette.rgb(42))
    assertEquals(rgb.camera_position, Vector3r(0.25f, 0, -3))

  test("a vehicle is visible to others and not to itself, by its name's id unless another is set"):
    val bench = this.bench()
    place(bench, "A", Vector3(0, 0, -3))
    place(bench, "B", Vector3(-2, 0, -3))
    bench.tell("simSetSegmentationObjectID", Str("B"), Int32(200), Bool(false))
    val Seq(ids) = shoot(bench, request(ImageKind.Infrared)): @unchecked
    assert(ids.image_data_uint8.contains(200.toByte))
    assert(!ids.image_data_uint8.contains(SceneObjects.defaultId("A").toByte))

  test("a single image is a PNG, and a camera looks in the direction that the settings state"):
    val bench = this.bench()
    place(bench, "A", Vector3(0, 0, -20))
    val png   = bench.now[Array[Byte]]("simGetImage", Str("nose"), Int32(0), Str("A"), Bool(false))
    val image = ImageIO.read(ByteArrayInputStream(png))
    assertEquals((image.getWidth, image.getHeight), (64, 32))
    assertEquals((0 until 64).map(image.getRGB(_, 16) & 0xffffff).distinct.size, 1)
    val info = bench.now[CameraInfo]("simGetCameraInfo", Str("nose"), Str("A"), Bool(false))
    assertEqualsFloat(info.fov, 60, 1e-3f)

  test("each image type has its own field of view, until a client sets the camera's"):
    val text  = """{"Vehicles": {"A": {"Cameras": {"front_center": {"CaptureSettings": [
      {"ImageType": 0, "FOV_Degrees": 60}, {"ImageType": 1, "FOV_Degrees": 30}]}}}}}"""
    val bench = Bench(Seq("A"), text = text)
    def fovs  =
      for kind <- Seq(ImageKind.Scene, ImageKind.DepthPlanar, ImageKind.Segmentation)
      yield (Shots.view(bench.simulation, 0, "front_center", kind.ordinal).fovDeg * 1000).round
    bench.tell(
      "simSetCameraPose",
      Str("0"),
      writeMsg(Pose(Vector3r(0, 0, 1), Quaternionr(1, 0, 0, 0))),
      Str("A"),
      Bool(false)
    )
    assertEquals(fovs, Seq(60_000L, 30_000L, 90_000L))
    bench.tell("simSetCameraFov", Str("0"), Float32(45), Str("A"), Bool(false))
    assertEquals(fovs, Seq(45_000L, 45_000L, 45_000L))

  test("lidars of cars and cameras look ahead from above the vehicle, and those of multirotors down"):
    val lidar =
      """"DefaultSensors": {"L": {"SensorType": 6, "Enabled": true}, "D": {"SensorType": 5, "Enabled": true}}"""
    val text  = s"""{"SimMode": "Car", $lidar, "Vehicles": {"A": {}, "B": {"VehicleType": "SimpleFlight"}}}"""
    val world = WorldSettings.parse(text).fold(error => fail(error.message), identity)
    val read  = SensorSettings.read(text).fold(error => fail(error.message), identity)
    val added = VehicleSettings("C", vehicleType = "ComputerVision")
    val seen  = (world.vehicles :+ added :+ VehicleSettings("D")).map: vehicle =>
      val (lidar, ranger) = (read.lidar(vehicle, "L").get._2, read.ranger(vehicle, "").get)
      (lidar.verticalFovDeg, lidar.place.position.z, ranger.place.position.z)
    val (ahead, down) = (((-10.0, 10.0), -1.0, -1.0), ((-45.0, -15.0), 0.0, 0.0))
    assertEquals(seen, Vector(ahead, down, ahead, down))

  test("equal poses give equal image bytes, whatever was drawn and flown before"):
    def digest(bench: Bench) =
      place(bench, "A", Vector3(1, 2, -3))
      place(bench, "B", Vector3(0, 2, -3))
      shoot(bench, ImageKind.values.take(8).map(request(_)).toSeq*).map(_.image_data_uint8.toSeq)
    val flown = this.bench()
    shoot(flown, request(ImageKind.Scene))
    flown.tell("simContinueForTime", Float64(1))
    flown.tell("reset")
    assertEquals(digest(flown), digest(this.bench()))

  test("unsupported image types are refused by name, and so are too many images"):
    val bench                            = this.bench()
    def refusal(requests: ImageRequest*) =
      bench.error("simGetImages", Arr(requests.map(writeMsg(_))*), Str("A"), Bool(false))
    assert(refusal(request(ImageKind.OpticalFlow)).contains("draws no OpticalFlow"))
    assert(refusal(request(ImageKind.Scene).copy(image_type =
      10
    )).contains("an image type is 0 to 9, not 10"))
    assert(refusal(request(ImageKind.Scene, camera = "nosuch")).contains("No camera with name nosuch exist"))
    assert(refusal(Seq.fill(65)(request(ImageKind.Scene))*).contains("at most 64 images"))

  test("detections are the filtered objects with a visible pixel, with the box around their pixels"):
    val bench = this.bench()
    place(bench, "A", Vector3(0, 0, -3))
    place(bench, "B", Vector3(50, 0, -3))
    def found = bench.now[Seq[DetectionInfo]]("simGetDetections", Str("0"), Int32(0), Str("A"), Bool(false))
    assertEquals(found, Seq.empty)
    for name <- Seq("hou*", "B") do
      bench.tell("simAddDetectionFilterMeshName", Str("0"), Int32(0), Str(name), Str("A"), Bool(false))
    // The house hides the other vehicle.
    assertEquals(found.map(_.name), Seq("House"))
    assertEquals(found.head.box3D, Box3D(Vector3r(-1, -4, -3), Vector3r(1, 4, 3)))
    assertEqualsFloat(found.head.relative_pose.position.x_val, 10.75f, 1e-4f)
    // 8 m across at 9.75 m through 90°: 8/9.75·128 pixels.
    assertEqualsFloat(found.head.box2D.max.x_val - found.head.box2D.min.x_val, 105, 1.1f)
    bench.tell("simSetDetectionFilterRadius", Str("0"), Int32(0), Float32(500), Str("A"), Bool(false))
    assertEquals(found, Seq.empty)

  test("objects are listed, read and moved, and block lines of sight"):
    val bench = this.bench()
    assertEquals(bench.now[Seq[String]]("simListSceneObjects", Str("H.*")), Seq("House"))
    val there = Pose(Vector3r(30, 0, -3), Quaternionr(1, 0, 0, 0))
    assert(bench.now[Boolean]("simSetObjectPose", Str("House"), writeMsg(there), Bool(true)))
    assertEquals(bench.now[Pose]("simGetObjectPose", Str("House")), there)
    place(bench, "A", Vector3(0, 0, -3))
    place(bench, "B", Vector3(0, 50, -3))
    assertEqualsFloat(
      shoot(bench, request(ImageKind.DepthPlanar, floats = true)).head.image_data_float(72 * 256 + 128),
      28.75f,
      1e-3f
    )

  test("a lidar takes a whole scan of one instant ten times per second, on the simulator's clock"):
    val bench = this.bench()
    place(bench, "A", Vector3(0, 0, -3))
    def scan(name: String) = bench.now[LidarData]("getLidarData", Str(name), Str("A"))
    bench.tell("simContinueForTime", Float64(0.15))
    val first = scan("")
    bench.tell("simContinueForTime", Float64(0.02))
    assertEquals(scan("").time_stamp, first.time_stamp)
    assert(scan("").point_cloud.sameElements(first.point_cloud))
    bench.tell("simContinueForTime", Float64(0.1))
    assertEquals(scan("Lidar").time_stamp.since(first.time_stamp), Span.ofMillis(100))
    assertEquals(first.segmentation.length * 3, first.point_cloud.length)
    assert(first.segmentation.contains(42) && first.segmentation.length > 4000)
    val house =
      first.segmentation.indices.filter(first.segmentation(_) == 42).map(i => first.point_cloud(3 * i))
    assertEqualsFloat(house.min, 10, 0.05f)
    assertEquals(scan("Own").time_stamp, bench.simulation.world.now)

  test("a distance sensor measures along its front, up to its range"):
    val bench    = this.bench()
    def distance = bench.now[DistanceSensorData]("getDistanceSensorData", Str(""), Str("A")).distance
    place(bench, "B", Vector3(0, 50, -3))
    place(bench, "A", Vector3(0, 0, -3))
    assertEqualsFloat(distance, 10, 1e-4f)
    place(bench, "A", Vector3(0, 0, -30))
    assertEqualsFloat(distance, 40, 1e-4f)

  test("a vehicle that flies into a house bounces off, and the collision is reported"):
    val bench = Bench(scene = scene).hovering(-3)
    bench.call(
      "moveByVelocity",
      Float32(5),
      Float32(0),
      Float32(0),
      Float32(6),
      Int32(0),
      writeMsg(YawMode.Still),
      Str("Evader")
    )
    var farthest = 0.0
    var told     = Option.empty[CollisionInfo]
    // Later it climbs along the wall, and over the roof.
    for _ <- 1 to 34 do
      bench.pass(0.1)
      farthest = math.max(farthest, bench.position().x)
      val collision = bench.now[CollisionInfo]("simGetCollisionInfo", Str("Evader"))
      if collision.has_collided && told.isEmpty then told = Some(collision)
    assert(farthest < 10 && farthest > 9, s"$farthest")
    assertEquals(told.map(_.object_name), Some("House"))
    assertEquals(told.map(_.normal), Some(Vector3r(-1, 0, 0)))

  test("contacts with objects are counted, a bounce as one, and contacts with the ground are not"):
    val bench                             = Bench(scene = scene).hovering(-3)
    def contacts                          = bench.simulation.world.vehicles.head.contacts
    def fly(north: Float, s: Float): Unit =
      bench.call(
        "moveByVelocityZ",
        Float32(north),
        Float32(0),
        Float32(-3),
        Float32(s),
        Int32(0),
        writeMsg(YawMode.Still),
        Str("Evader")
      )
      bench.pass(s + 1)
    assertEquals(contacts, 0L)
    fly(5, 6)
    val first = contacts
    // It flies against the wall again and again, in hundreds of steps.
    assert(first >= 1 && first < 10, first)
    fly(-5, 3)
    assertEquals(contacts, first)
    fly(5, 6)
    val second = contacts
    assert(second > first, second)
    bench.call("land", Float32(60), Str("Evader"))
    bench.pass(60)
    assertEquals(contacts, second)

  test("an invalid value in the settings is reported with its key"):
    def error(text: String) = SensorSettings.read(text).fold(_.message, equipment => fail(s"$equipment"))
    assert(error(
      """{"CameraDefaults": {"CaptureSettings": [{"Width": 0}]}}"""
    ).contains("CameraDefaults.CaptureSettings[0].Width: expected a number from 1 to 8192, found 0"))
    val frame =
      """{"Vehicles": {"A": {"Sensors": {"L": {"SensorType": 6, "Enabled": true, "DataFrame": "x"}}}}}"""
    assert(error(
      frame
    ).contains("Vehicles.A.Sensors.L.DataFrame: expected VehicleInertialFrame or SensorLocalFrame"))
