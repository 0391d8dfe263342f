package skein.simulator

import skein.airsim.wire.*
import skein.airsim.{SensorKind, VehicleSettings}
import skein.rpc.Rpclib
import skein.units.*
import upack.{Obj, Str}

/** Resolution of vehicle names and sensor names. */
class NamesSuite extends munit.FunSuite:

  private def north(bench: Bench, name: String): Double =
    // Home positions distinguish vehicles that stand still.
    bench.now[GeoPoint]("getHomeGeoPoint", Str(name)).latitude

  private val apart = Seq("Pursuer", "Evader", "Zebra").zipWithIndex.map((name, i) =>
    VehicleSettings(name, Vector3(i * 1000.0, 0, 0))
  )

  test("vehicles are listed alphabetically, and the empty name means the first"):
    val bench = Bench.of(apart*)
    assertEquals(bench.now[Seq[String]]("listVehicles"), Seq("Evader", "Pursuer", "Zebra"))
    assertEquals(north(bench, ""), north(bench, "Evader"))
    assertNotEquals(north(bench, "Pursuer"), north(bench, "Evader"))

  test("the empty name means the vehicle with IsFpvVehicle, if there is one"):
    val bench = Bench.of(apart.map(vehicle => vehicle.copy(firstPerson = vehicle.name == "Pursuer"))*)
    assertEquals(north(bench, ""), north(bench, "Pursuer"))

  test("a vehicle type is recognised in any letter case"):
    for kind <- Seq("simpleflight", "SIMPLEFLIGHT", "SimpleFlight", "computervision") do
      assert(SettingsFile.read(s"""{"Vehicles": {"A": {"VehicleType": "$kind"}}}""").isRight, kind)
    assert(SettingsFile.read("""{"Vehicles": {"A": {"VehicleType": "PX4"}}}""").isLeft)

  private val sensors = Seq(
    ("getImuData", "imu", "IMU"),
    ("getGpsData", "gps", "gps"),
    ("getBarometerData", "barometer", "barometer"),
    ("getMagnetometerData", "magnetometer", "magnetometer")
  )

  test("a sensor is found by its name or by none; another name is refused in AirSim's words"):
    val bench = Bench()
    for (method, name, kind) <- sensors do
      assert(bench.answerOf(bench.call(method, Str(name), Str(""))).isRight)
      assert(bench.answerOf(bench.call(method, Str(""), Str(""))).isRight)
      for wrong <- Seq("nosuch", name.toUpperCase(java.util.Locale.ROOT)) do
        assertEquals(
          bench.error(method, Str(wrong), Str("")),
          Rpclib.threw(method, 2, s"No $kind with name $wrong exist on vehicle")
        )

  test("sensors in the settings replace the default ones of their kind"):
    val bench =
      Bench.of(VehicleSettings("A", sensors = SensorKind.Default - "imu" + ("Imu1" -> SensorKind.Imu)))
    assert(bench.answerOf(bench.call("getImuData", Str("Imu1"), Str(""))).isRight)
    assert(bench.error("getImuData", Str("imu"), Str("")).contains("No IMU with name imu exist on vehicle"))

  test("rotor states have thrust and signed torque as at sea level, and a speed that is never negative"):
    val bench  = Bench().hovering(-20)
    val answer = bench.answerOf(bench.call("getRotorStates", Str(""))).toOption.get
    assertEquals(answer.asInstanceOf[Obj].value.keys.toSeq, Seq[upack.Msg](Str("rotors"), Str("timestamp")))
    val rotors = upickle.default.readBinary[RotorStates](answer).rotors
    // The hover control at this altitude is 0.5947 of 4.1794 N.
    rotors.foreach(rotor => assertEqualsDouble(rotor.thrust, 0.5947 * 4.1794, 1e-3))
    assertEquals(rotors.map(_.torque_scaler.sign.toInt), Seq(-1, -1, 1, 1))
    rotors.foreach(rotor => assertEqualsDouble(math.abs(rotor.torque_scaler), 0.5947 * 0.05556, 1e-5))
    rotors.foreach(rotor => assertEqualsDouble(rotor.speed, math.sqrt(0.5947) * 669.857, 0.05))

  private def gps(bench: Bench) = bench.now[GpsData]("getGpsData", Str(""), Str(""))

  test("a reset within the GPS's first second silences it for another; later resets do not"):
    val bench = Bench()
    bench.pass(0.9)
    bench.tell("reset")
    bench.pass(0.9)
    assert(!gps(bench).is_valid)
    bench.pass(0.2)
    assert(gps(bench).is_valid)
    bench.tell("reset")
    assert(gps(bench).is_valid)

  test(
    "the GPS is silent for a second after the start, and its dilutions fall to 0.1 then and after a reset"
  ):
    val bench = Bench()
    def gps   = this.gps(bench)
    for isFirst <- Seq(true, false) do
      bench.pass(0.99)
      val silent = gps
      assertEquals(silent.is_valid, !isFirst)
      if isFirst then assertEquals(silent.gnss.geo_point, GeoPoint(0, 0, 0))
      assertEquals(silent.gnss.fix_type, 0)
      bench.pass(0.02)
      val first = gps
      assert(first.is_valid)
      assertEquals(first.gnss.fix_type, 0)
      assertEqualsDouble(first.gnss.eph, 0.1 + 99.9 * math.exp(-1.01 / 0.9), 0.01)
      assertEqualsDouble(first.gnss.geo_point.altitude, 122, 0.01)
      bench.pass(9)
      val settled = gps
      assertEqualsDouble(settled.gnss.eph, 0.1, 0.01)
      assertEquals(settled.gnss.fix_type, 3)
      bench.tell("reset")
