package skein.airsim

import skein.units.*

class WorldSettingsSuite extends munit.FunSuite:

  private def problem(text: String): String =
    WorldSettings.parse(text).left.map(_.message).left.getOrElse("none")

  test("settings without vehicles get AirSim's default vehicle"):
    assertEquals(WorldSettings.parse("{}").map(_.vehicles), Right(Vector(VehicleSettings("SimpleFlight"))))

  test("SimMode sets the type of vehicles without one, and a world may have vehicles of both types"):
    assertEquals(
      WorldSettings.parse("""{"SimMode": "Car"}""").map(_.vehicles),
      Right(Vector(VehicleSettings(
        "PhysXCar",
        vehicleType = "PhysXCar",
        sensors = WorldSettings.usualSensors("PhysXCar")
      )))
    )
    val mixed = WorldSettings.parse(
      """{"SimMode": "Car", "Vehicles": {"A": {"X": 3}, "B": {"VehicleType": "SimpleFlight"}}}"""
    )
    assertEquals(
      mixed.map(_.vehicles.map(one => (one.name, one.isCar))),
      Right(Vector(("A", true), ("B", false)))
    )
    assertEquals(
      WorldSettings.parse("""{"SimMode": 1}""").left.map(_.message),
      Left("SimMode: expected a string, found a number")
    )
    val cars = mixed.toOption.get.vehicles.take(1)
    assert(WorldSettings.render(cars).contains("\"SimMode\": \"Car\""))
    assertEquals(WorldSettings.parse(WorldSettings.render(cars)).map(_.vehicles), Right(cars))

  test("vehicles, origin, wind and clock speed are read, everything else is ignored"):
    val text = """{"SettingsVersion": 1.2, "SimMode": "Multirotor", "ClockSpeed": 2,
      "Wind": {"X": 1, "Y": -2}, "OriginGeopoint": {"Latitude": 47, "Longitude": 8, "Altitude": 400},
      "Vehicles": {
        "Evader": {"VehicleType": "SimpleFlight", "X": 0, "Y": 0, "Z": 0},
        "Pursuer": {"VehicleType": "SimpleFlight", "X": -21, "Yaw": 90, "Cameras": {}}}}"""
    assertEquals(
      WorldSettings.parse(text),
      Right(
        WorldSettings(
          Vector(
            VehicleSettings("Evader"),
            VehicleSettings("Pursuer", Vector3(-21, 0, 0), Radians(math.Pi / 2))
          ),
          GeoLocation(47, 8, Metres(400)),
          Vector3(1, -2, 0),
          2.0,
          text
        )
      )
    )

  test("vehicles with AutoCreate false do not exist, and SimMode may be ComputerVision, too"):
    val text  = """{"SimMode": "ComputerVision", "ApiServerPort": 42, "Vehicles":
      {"A": {"AutoCreate": true}, "B": {"VehicleType": "PX4Multirotor", "AutoCreate": false}}}"""
    val world = WorldSettings.parse(text).fold(error => fail(error.message), identity)
    assertEquals(world.vehicles.map(vehicle => (vehicle.name, vehicle.isCamera)), Vector(("A", true)))
    assertEquals(world.apiPort, Some(42))

  test("the default vehicle carries DefaultSensors if the settings list no vehicles"):
    val world = WorldSettings.parse("""{"DefaultSensors": {"G": {"SensorType": 3, "Enabled": true}}}""")
    assertEquals(
      world.map(_.vehicles.head.sensors),
      Right(SensorKind.Default - "gps" + ("G" -> SensorKind.Gps))
    )

  test("rendered settings are read back unchanged"):
    val vehicles = Vector(VehicleSettings("A", Vector3(1, 2, -3)), VehicleSettings("B"))
    assertEquals(WorldSettings.parse(WorldSettings.render(vehicles)).map(_.vehicles), Right(vehicles))

  test("an error about a value states its path, what was expected and what was found"):
    assertEquals(
      problem("""{"Vehicles": {"A": {"X": "1"}}}"""),
      "Vehicles.A.X: expected a number, found a string"
    )
    assertEquals(problem("""{"Vehicles": [1]}"""), "Vehicles: expected an object, found an array")
    assertEquals(problem("""{"ClockSpeed": 0}"""), "ClockSpeed: expected a number above 0, found 0.0")
    assertEquals(problem("[]"), "the whole: expected an object, found an array")
    assertEquals(problem("{"), "not JSON: it ends too early")
    assertEquals(problem(""), "not JSON: it ends too early")
    assert(clue(problem("{\n  \"A\": 1,\n  oops\n}")).endsWith(", in line 3"))
    assert(clue(problem("[" * 100_000)).length < 250)

  private def only(fields: String, more: String = ""): VehicleSettings =
    WorldSettings.parse(s"""{"Vehicles": {"A": {$fields}} $more}""").fold(
      e => fail(e.message),
      _.vehicles.head
    )

  test("the default vehicle is the one with IsFpvVehicle, else the alphabetically first"):
    def default(text: String) = WorldSettings.parse(text).map(_.defaultVehicle.name)
    assertEquals(default("""{"Vehicles": {"B": {}, "A": {}}}"""), Right("A"))
    assertEquals(default("""{"Vehicles": {"B": {"IsFpvVehicle": true}, "A": {}}}"""), Right("B"))

  test("DefaultVehicleState sets whether a vehicle is armed from the start"):
    assert(only("").armed)
    assert(only(""" "DefaultVehicleState": "Armed" """).armed)
    assert(!only(""" "DefaultVehicleState": "Inactive" """).armed)
    assertEquals(
      problem("""{"Vehicles": {"A": {"DefaultVehicleState": "flying"}}}"""),
      "Vehicles.A.DefaultVehicleState: expected Armed, Inactive or Disarmed, found 'flying'"
    )

  test("listed sensors replace the default ones of their kind; disabled ones do not exist"):
    assertEquals(only("").sensors, SensorKind.Default)
    val own =
      only(""" "Sensors": {"Imu1": {"SensorType": 2, "Enabled": true}, "Off": {"SensorType": 3}} """).sensors
    assertEquals(own, SensorKind.Default - "imu" - "gps" + ("Imu1" -> SensorKind.Imu))
    val fork = only(""" "Sensors": {"Echo": {"SensorType": 9, "Enabled": true}} """).sensors
    assertEquals(fork, SensorKind.Default)
    val shared = only("", """, "DefaultSensors": {"G": {"SensorType": 3, "Enabled": true}}""").sensors
    assertEquals(shared, SensorKind.Default - "gps" + ("G" -> SensorKind.Gps))

  test("a car has a GPS by default and a camera nothing, as in AirSim"):
    def sensors(text: String) =
      WorldSettings.parse(text).fold(error => fail(error.message), _.vehicles.map(_.sensors))
    val gps = Map("gps" -> SensorKind.Gps)
    assertEquals(sensors("""{"SimMode": "Car"}"""), Vector(gps))
    assertEquals(sensors("""{"SimMode": "ComputerVision"}"""), Vector(Map.empty))
    assertEquals(
      sensors("""{"SimMode": "Car", "DefaultSensors": {"I": {"SensorType": 2, "Enabled": true}},
        "Vehicles": {"A": {}, "B": {"VehicleType": "SimpleFlight"}}}"""),
      Vector(gps + ("I" -> SensorKind.Imu), SensorKind.Default - "imu" + ("I" -> SensorKind.Imu))
    )
