package skein.simulator

import skein.airsim.wire.{
  CollisionInfo,
  GpsData,
  ImageRequest,
  ImageResponse,
  LidarData,
  Pose,
  Quaternionr,
  Vector3r
}
import skein.airsim.{SensorKind, SettingsError}
import skein.link.Address
import upack.{Arr, Bool, Str}
import upickle.default.writeMsg

/** AirSim's `settings.json`, key by key: obeyed, refused, or reported as having no effect. */
class SettingsFileSuite extends munit.FunSuite:

  private def read(text: String): SettingsFile =
    SettingsFile.read(text).fold(error => fail(error.message), identity)

  private def problem(text: String): String =
    SettingsFile.read(text).fold(_.message, file => fail(s"$file is not refused"))

  private def bench(text: String): Bench =
    val world = read(text).world
    Bench(world.vehicles.map(_.name), world.vehicles, text = text)

  private val sensing = """"DefaultSensors": {
    "Lidar1": {"SensorType": 6, "Enabled": true, "NumberOfChannels": 16, "PointsPerSecond": 10000, "Z": -1},
    "Range1": {"SensorType": 5, "Enabled": true, "Pitch": -90},
    "Gps2": {"SensorType": 3, "Enabled": true}}"""

  test("the default vehicle of a file without Vehicles, and an added one, carry the DefaultSensors"):
    val flown = bench(s"{$sensing}")
    flown.tell(
      "simAddVehicle",
      Str("Late"),
      Str("SimpleFlight"),
      writeMsg(Pose(Vector3r(0, 9, 0), Quaternionr(1, 0, 0, 0))),
      Str("")
    )
    flown.pass(1.5)
    for vehicle <- Seq("SimpleFlight", "Late") do
      val scan = flown.now[LidarData]("getLidarData", Str("Lidar1"), Str(vehicle))
      assert(scan.point_cloud.length > 100, vehicle)
      assert(flown.answerOf(flown.call("getDistanceSensorData", Str("Range1"), Str(vehicle))).isRight)
      assert(flown.now[GpsData]("getGpsData", Str("Gps2"), Str("SimpleFlight")).is_valid)
    val listed = bench(
      s"""{$sensing, "Vehicles": {"A": {}, "B": {"Sensors": {"L": {"SensorType": 6, "Enabled": true}}}}}"""
    )
    assert(listed.answerOf(listed.call("getLidarData", Str("Lidar1"), Str("A"))).isRight)
    assert(listed.error("getLidarData", Str("Lidar1"), Str("B")).contains("No lidar with name Lidar1"))

  test("ApiServerPort is the listening port, and an invalid one is refused"):
    assertEquals(read("""{"ApiServerPort": 42099}""").world.apiPort, Some(42099))
    assertEquals(read("{}").world.apiPort, None)
    assertEquals(
      problem("""{"ApiServerPort": 0}"""),
      "ApiServerPort: expected a number from 1 to 65535, found 0"
    )
    assertEquals(problem("""{"ApiServerPort": 80.5}"""), "ApiServerPort: expected a whole number, found 80.5")

  test("vehicles with AutoCreate false do not exist, whatever their type"):
    val file = read("""{"Vehicles": {"A": {}, "B": {"X": 4, "AutoCreate": false},
      "P": {"VehicleType": "PX4Multirotor", "AutoCreate": false, "UseSerial": false}}}""")
    assertEquals((file.world.vehicles.map(_.name), file.notice), (Vector("A"), None))
    assertEquals(
      problem("""{"Vehicles": {"A": {"AutoCreate": false}}}"""),
      "Vehicles: expected at least one without AutoCreate false, found none"
    )

  test("a camera of ComputerVision keeps its position, whether SimMode or its type makes it one"):
    for
      text <- Seq(
        """{"SimMode": "ComputerVision"}""",
        """{"SimMode": "ComputerVision", "Vehicles": {"Cam": {"VehicleType": "ComputerVision", "Z": -5}}}""",
        """{"Vehicles": {"Cam": {"VehicleType": "computervision"}}}"""
      )
    do
      val rig             = bench(text)
      def put(pose: Pose) = rig.tell("simSetVehiclePose", writeMsg(pose), Bool(true), Str(""))
      for i <- Seq(0f, 5f, 10f) do
        put(Pose(Vector3r(i, 0, -10), Quaternionr(1, 0, 0, 0)))
        rig.pass(1)
        assertEquals(rig.now[Pose]("simGetVehiclePose", Str("")).position, Vector3r(i, 0, -10))
        assert(!rig.now[CollisionInfo]("simGetCollisionInfo", Str("")).has_collided)
        val images = rig.now[Seq[ImageResponse]](
          "simGetImages",
          Arr(writeMsg(ImageRequest("0", 0, pixels_as_float = false, compress = false))),
          Str(""),
          Bool(false)
        )
        assertEquals(images.head.camera_position, Vector3r(i + 0.25f, 0, -10))
      assert(rig.error("takeoff", upack.Float32(1), Str("")).contains("is a camera"))
      rig.tell("reset")
      assertEquals(rig.now[Pose]("simGetVehiclePose", Str("")).position, Vector3r(0, 0, 0))

  test("keys without effect are reported in one line, by path; disabled parts are not"):
    val file =
      read("""{"SettingsVersion": 1.2, "SimMode": "Multirotor", "ViewMode": "Fpv", "LocalHostIp": "127.0.0.1",
      "SubWindows": [{"WindowID": 0}], "Recording": {"RecordOnMove": false}, "ClockSpeed": 1, "Wind": {"X": 1},
      "OriginGeopoint": {"Latitude": 47, "Longitude": 8, "Altitude": 400},
      "CameraDefaults": {"CaptureSettings": [{"Width": 40, "TargetGamma": 1}], "Gimbal": {"Pitch": 0}},
      "DefaultSensors": {"Off": {"SensorType": 6, "Range": 3}, "Echo": {"SensorType": 9, "Enabled": true, "X": 1}},
      "Vehicles": {"A": {"PawnPath": "x", "Roll": 1, "Yaw": 90, "RC": {"RemoteControlID": 0},
        "Cameras": {"c": {"X": 1, "CaptureSettings": [{"ImageType": 1}], "NoiseSettings": []}}}}}""")
    assertEquals(
      file.ignored,
      Vector(
        "ViewMode",
        "SubWindows",
        "Recording",
        "CameraDefaults.CaptureSettings[0].TargetGamma",
        "CameraDefaults.Gimbal",
        "DefaultSensors.Echo",
        "Vehicles.A.PawnPath",
        "Vehicles.A.Roll",
        "Vehicles.A.RC",
        "Vehicles.A.Cameras.c.NoiseSettings"
      )
    )
    assert(file.notice.get.startsWith("without effect here: ViewMode, SubWindows, Recording, "))
    val many = read((1 to 50).map(i => s"\"Unknown$i\": $i").mkString("{", ", ", "}"))
    assert(many.notice.get.endsWith("Unknown20 and 30 more"), many.notice)

  test("a file does not open a simulator to the network, and that is reported"):
    assertEquals(read("""{"LocalHostIp": "127.0.0.1"}""").notice, None)
    val open = read("""{"LocalHostIp": "0.0.0.0"}""")
    assert(clue(open.notice.get).contains("LocalHostIp (only this machine can connect, unless --listen"))
    assertEquals(SimulatorSettings(open.world).address, Address("127.0.0.1", 41451))

  test("modes, engines and values that cannot be obeyed are refused with their key"):
    for
      (text, told) <- Seq(
        """{"SimMode": "SkidVehicle"}""" -> "SimMode: expected Multirotor or Car or ComputerVision, found 'SkidVehicle'",
        """{"PhysicsEngineName": "ExternalPhysicsEngine"}""" ->
          "PhysicsEngineName: expected FastPhysicsEngine or PhysX, found 'ExternalPhysicsEngine'",
        """{"RpcEnabled": false}"""  -> "RpcEnabled: expected true, found false",
        """{"SettingsVersion": 3}""" -> "SettingsVersion: expected a number from 1 to 2, found 3",
        """{"ClockSpeed": 1e9}"""    -> "ClockSpeed: expected a number from 0.001 to 1000, found 1000000000",
        """{"Wind": {"Y": 1e6}}"""   -> "Wind: expected at most 300 m/s, found 1000000 m/s",
        """{"Wind": {"X": 299, "Y": 30}}"""        -> "Wind: expected at most 300 m/s, found 301 m/s",
        """{"OriginGeopoint": {"Latitude": 91}}""" ->
          "OriginGeopoint.Latitude: expected a number from -90 to 90, found 91",
        """{"Vehicles": {"A": {"X": 1e8}}}""" ->
          "Vehicles.A.X: expected a number from -1000000 to 1000000, found 100000000",
        """{"Vehicles": {"A": {"VehicleType": "PX4Multirotor"}}}""" ->
          "Vehicles.A.VehicleType: expected SimpleFlight, PhysXCar, ComputerVision, found 'PX4Multirotor'",
        """{"Vehicles": {"": {}}}""" -> "Vehicles.: expected a name of 1 to 100 characters, found 0"
      )
    do assertEquals(problem(text), told)
    val crowd = (1 to 257).map(i => s"\"V$i\": {}").mkString("{\"Vehicles\": {", ", ", "}}")
    assertEquals(problem(crowd), "Vehicles: expected at most 256, found 257")

  test("a message is one line of limited length, for any keys and values of the file"):
    val long = "x" * 10_000
    for
      text <- Seq(
        s"""{"SimMode": "$long"}""",
        s"""{"Vehicles": {"$long\\n\\u001b[2J": {"X": "1"}}}""",
        s"""{"Vehicles": {"A": {"DefaultVehicleState": "a\\nb$long"}}}""",
        long
      )
    do
      val told = problem(text)
      assert(told.length < 500 && !told.exists(_.isControl), told.take(600))

  test("mutated files are read or refused in one line each"):
    val figures = MutatedSettings.run(300, 43)
    assert(figures.refused > 100 && figures.read > 20, figures)

  test("the default vehicle has the DefaultSensors, and default sensors of the kinds that they do not list"):
    val sensors = read(s"{$sensing}").world.vehicles.head.sensors
    assertEquals(sensors.get("Gps2"), Some(SensorKind.Gps))
    assert(!sensors.contains("gps") && sensors.contains("imu"))

  test("a shortened text is marked"):
    assertEquals(SettingsError.shown("a" * 121), "a" * 120 + "…")
