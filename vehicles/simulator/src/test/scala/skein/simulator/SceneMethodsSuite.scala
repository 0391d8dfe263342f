package skein.simulator

import skein.airsim.wire.*
import skein.units.*
import upack.*
import upickle.default.writeMsg

class SceneMethodsSuite extends munit.FunSuite:

  private def pose(x: Double, y: Double, z: Double, q: Quaternion = Quaternion.Identity): Msg =
    writeMsg(Pose(Vector3r(Vector3(x, y, z)), Quaternionr(q)))

  /** A position in the default world, whose origin is AirSim's home, as latitude, longitude and altitude. */
  private def point(ned: Vector3): Msg =
    val place = skein.airsim.WorldSettings.DefaultOrigin.locate(ned)
    writeMsg(GeoPoint(place.latitudeDeg, place.longitudeDeg, place.altitude.value.toFloat))

  test("an added vehicle starts at the origin of its own frame, and flies along with the other vehicles"):
    val bench = Bench()
    assert(bench.now[Boolean]("simAddVehicle", Str("Drone2"), Str("simpleflight"), pose(10, 5, 0), Str("")))
    assert(bench.now[Seq[String]]("listVehicles").contains("Drone2"))
    assertEquals(bench.position("Drone2"), Vector3.Zero)
    assertEquals(bench.now[Pose]("simGetObjectPose", Str("Drone2")).position, Vector3r(10, 5, 0))
    for name <- Seq("Evader", "Drone2") do
      bench.tell("enableApiControl", Bool(true), Str(name))
      bench.tell("armDisarm", Bool(true), Str(name))
    val takeoffs = Seq("Evader", "Drone2").map(name => bench.call("takeoff", Float32(20), Str(name)))
    bench.pass(20)
    assertEquals(takeoffs.map(bench.answeredAt(_).nonEmpty), Seq(true, true))
    assertEqualsDouble(bench.position("Drone2").z, bench.position("Evader").z, 1e-6)
    bench.tell("reset")
    assertEquals(bench.position("Drone2"), Vector3.Zero)

  test("a vehicle added in the air falls, and the current wind affects it"):
    val bench = Bench()
    bench.tell("simSetWind", writeMsg(Vector3r(10, 0, 0)))
    bench.tell("simAddVehicle", Str("High"), Str("SimpleFlight"), pose(0, 0, -50), Str(""))
    bench.pass(1)
    assert(bench.position("High").z > 3)
    assert(bench.position("High").x > 0.01)

  test("a used name and an unknown type are answered with false, and names and numbers have limits"):
    val bench                           = Bench()
    def add(name: String, kind: String) =
      bench.now[Boolean]("simAddVehicle", Str(name), Str(kind), pose(0, 0, 0), Str(""))
    assertEquals(add("Evader", "simpleflight"), false)
    assertEquals(add("Ground", "simpleflight"), false)
    assertEquals(add("Car", "ArduRover"), false)
    assert(bench.error(
      "simAddVehicle",
      Str(""),
      Str("simpleflight"),
      pose(0, 0, 0),
      Str("")
    ).contains("1 to 100"))
    for i <- 1 until VehicleLimits.MostVehicles do assert(add(s"Drone$i", "SIMPLEFLIGHT"))
    assert(bench.error(
      "simAddVehicle",
      Str("x"),
      Str("simpleflight"),
      pose(0, 0, 0),
      Str("")
    ).contains("at most 256"))

  test("kinematics are set unchanged, and the flight continues from there"):
    val bench = Bench().hovering(-20)
    val zero  = Vector3r.Zero
    val tilt  = Quaternionr(Quaternion(math.cos(0.1), 0, math.sin(0.1), 0))
    val set   =
      KinematicsState(Vector3r(3, 4, -30), tilt, Vector3r(5, -2, 1), Vector3r(0.1f, 0.2f, 0.3f), zero, zero)
    bench.tell("simPause", Bool(true))
    bench.tell("simSetKinematics", writeMsg(set), Bool(true), Str(""))
    assertEquals(bench.kinematics(), set)
    bench.tell("simPause", Bool(false))
    bench.pass(0.3)
    assertEqualsDouble(bench.position().x, 3 + 0.3 * 5, 0.5)
    assertEqualsDouble(bench.position().y, 4 - 0.3 * 2, 0.3)

  test("kinematics that would overflow are refused"):
    val zero = Vector3r.Zero
    val far  = KinematicsState(Vector3r(1e30f, 0, 0), Quaternionr(1, 0, 0, 0), zero, zero, zero, zero)
    assert(Bench().error("simSetKinematics", writeMsg(far), Bool(true), Str("")).contains("within"))

  test("objects are listed by whole names, have poses in the world, and only vehicles can be moved"):
    val bench               = Bench(Seq("Evader", "Pursuer"))
    def list(regex: String) = bench.now[Seq[String]]("simListSceneObjects", Str(regex)).toSet
    assertEquals(list(".*"), Set("Ground", "Evader", "Pursuer"))
    assertEquals(list(".*r"), Set("Evader", "Pursuer"))
    assertEquals(list("vader"), Set.empty)
    assert(bench.now[Boolean]("simSetObjectPose", Str("Pursuer"), pose(7, 8, -9), Bool(true)))
    assertEquals(bench.now[Pose]("simGetObjectPose", Str("Pursuer")).position, Vector3r(7, 8, -9))
    assertEquals(bench.now[Boolean]("simSetObjectPose", Str("Ground"), pose(0, 0, 1), Bool(true)), false)
    assert(bench.now[Pose]("simGetObjectPose", Str("Tree")).position.x_val.isNaN)
    assertEquals(bench.now[Vector3r]("simGetObjectScale", Str("Evader")), Vector3r(1, 1, 1))
    assert(bench.now[Boolean]("simSetObjectScale", Str("Evader"), writeMsg(Vector3r(2, 2, 2))))
    assertEquals(bench.now[Vector3r]("simGetObjectScale", Str("Evader")), Vector3r(2, 2, 2))
    assertEquals(bench.now[Vector3r]("simGetObjectScale", Str("Tree")), Vector3r.Zero)

  test("an expression on which backtracking never ends is answered, and an invalid one is refused"):
    val bench = Bench(Seq("a" * 60))
    assertEquals(bench.now[Seq[String]]("simListSceneObjects", Str(".*.*.*.*.*.*.*.*b")), Nil)
    assertEquals(bench.now[Seq[String]]("simListSceneObjects", Str("(.*)*" * 60 + "x")), Nil)
    assertEquals(
      bench.now[Boolean]("simSetSegmentationObjectID", Str("(.*)*" * 60 + "x"), upack.Int32(1), Bool(true)),
      false
    )
    assert(bench.error("simListSceneObjects", Str("(")).contains("no regular expression"))
    assert(bench.error("simListSceneObjects", Str("(" * 2000)).contains("at most 1000"))
    assertEquals(bench.now[Boolean]("ping"), true)

  test("segmentation ids are AirSim's unless set, by name or by expression in any letter case"):
    val bench            = Bench()
    def id(name: String) = bench.now[Int]("simGetSegmentationObjectID", Str(name))
    // 5 and g + r + o + u + n + d, modulo 256.
    assertEquals(id("Ground"), (5 + "ground".map(_.toInt).sum) % 256)
    assertEquals(id("Tree"), -1)
    def set(name: String, id: Int, regex: Boolean) =
      bench.now[Boolean]("simSetSegmentationObjectID", Str(name), Int32(id), Bool(regex))
    assert(set("[\\w]*", 0, regex = true))
    assertEquals(id("Ground") -> id("Evader"), 0 -> 0)
    assert(set("gro.*", 20, regex = true))
    assertEquals(id("Ground") -> id("Evader"), 20 -> 0)
    assertEquals(set("evader", 3, regex = false), false)
    assert(set("Evader", 300, regex = false))
    assertEquals(id("Evader"), 255)

  test("a vehicle has a line of sight unless the ground or another vehicle blocks it"):
    val bench                          = Bench(Seq("Evader", "Pursuer"))
    def put(name: String, at: Vector3) =
      bench.tell("simSetVehiclePose", pose(at.x, at.y, at.z), Bool(true), Str(name))
    bench.tell("simPause", Bool(true))
    put("Evader", Vector3(0, 0, -10))
    put("Pursuer", Vector3(20, 0, -10))
    def sees(to: Vector3) = bench.now[Boolean]("simTestLineOfSightToPoint", point(to), Str("Evader"))
    assert(sees(Vector3(15, 0, -10)))
    assert(!sees(Vector3(40, 0, -10)), "the other vehicle is in the way")
    assert(sees(Vector3(40, 3, -10)))
    assert(sees(Vector3(40, 0, -12)))
    assert(sees(Vector3(40, 0, 0)), "what lies on the ground")
    assert(!sees(Vector3(40, 0, 2)), "what lies below the ground")
    def between(from: Vector3, to: Vector3) =
      bench.now[Boolean]("simTestLineOfSightBetweenPoints", point(from), point(to))
    assert(!between(Vector3(-5, 0, -10), Vector3(5, 0, -10)), "the first vehicle")
    assert(between(Vector3(-5, 0, -11), Vector3(5, 0, -11)))
    assert(!between(Vector3(0, 0, 5), Vector3(1, 0, -1)))

  test("the world's extents contain the origin"):
    val corners = Bench().now[Seq[GeoPoint]]("simGetWorldExtents")
    val home    = skein.airsim.WorldSettings.DefaultOrigin
    assert(corners(0).latitude < home.latitudeDeg && home.latitudeDeg < corners(1).latitude)
    assert(corners(0).longitude < home.longitudeDeg && home.longitudeDeg < corners(1).longitude)
    assert(corners(0).altitude < corners(1).altitude)

  test("assets, levels and meshes are refused in AirSim's words"):
    val bench = Bench()
    assertEquals(bench.now[Seq[String]]("simListAssets"), Seq.empty)
    assertEquals(bench.now[Boolean]("simLoadLevel", Str("Blocks")), false)
    assertEquals(bench.now[Boolean]("simDestroyObject", Str("Evader")), false)
    val refusal =
      bench.error(
        "simSpawnObject",
        Str("a"),
        Str("Cube"),
        pose(0, 0, 0),
        writeMsg(Vector3r(1, 1, 1)),
        Bool(false),
        Bool(false)
      )
    assert(refusal.contains("There were no objects with name Cube found in the Registry"), refusal)
