package skein.simulator

import skein.airsim.wire.*
import skein.units.*
import upack.*
import upickle.default.writeMsg

class CameraMethodsSuite extends munit.FunSuite:

  private def info(bench: Bench, camera: String): CameraInfo =
    bench.now[CameraInfo]("simGetCameraInfo", Str(camera), Str(""), Bool(false))

  private def turned(yawDeg: Double, pitchDeg: Double = 0): Quaternion =
    val (yaw, pitch) = (math.toRadians(yawDeg) / 2, math.toRadians(pitchDeg) / 2)
    Quaternion(math.cos(yaw), 0, 0, math.sin(yaw)) * Quaternion(math.cos(pitch), 0, math.sin(pitch), 0)

  private def forward(pose: Pose): Vector3 =
    pose.orientation.toQuaternion.toWorld(Vector3(1, 0, 0))

  private def near(a: Vector3, b: Vector3): Unit = assert((a - b).norm < 1e-5, s"$a, expected $b")

  test("cameras look in the direction that their names state, including AirSim's alternative names"):
    val bench = Bench()
    for (name, direction) <- Seq(
        "front_center"  -> Vector3(1, 0, 0),
        "0"             -> Vector3(1, 0, 0),
        ""              -> Vector3(1, 0, 0),
        "fpv"           -> Vector3(1, 0, 0),
        "1"             -> Vector3(1, 0, 0),
        "bottom_center" -> Vector3(0, 0, 1),
        "3"             -> Vector3(0, 0, 1),
        "back_center"   -> Vector3(-1, 0, 0),
        "4"             -> Vector3(-1, 0, 0)
      )
    do near(forward(info(bench, name).pose), direction)
    val apart = info(bench, "front_right").pose.position.y_val - info(bench, "2").pose.position.y_val
    assertEqualsDouble(apart, 0.25, 1e-6)
    assertEqualsDouble(info(bench, "0").fov, 90, 1e-4)

  test("a camera keeps the pose that was set, and moves with its vehicle"):
    val bench = Bench()
    val pose  = writeMsg(Pose(Vector3r(1, 0, 0), Quaternionr(turned(0, pitchDeg = -90))))
    bench.tell("simPause", Bool(true))
    bench.tell("simSetCameraPose", Str("0"), pose, Str(""), Bool(false))
    val vehicle = Pose(Vector3r(10, 20, -30), Quaternionr(turned(90)))
    bench.tell("simSetVehiclePose", writeMsg(vehicle), Bool(true), Str(""))
    val seen = info(bench, "front_center").pose
    near(seen.position.toVector, Vector3(10, 21, -30))
    near(forward(seen), Vector3(0, 0, 1))
    near(forward(info(bench, "front_left").pose), Vector3(0, 1, 0))

  test("field of view and focal length determine each other, within the lens's range"):
    val bench                             = Bench()
    def number(method: String)            = bench.now[Float](method, Str("0"), Str(""), Bool(false)).toDouble
    def set(method: String, params: Msg*) = bench.tell(method, params ++ Seq(Str("0"), Str(""), Bool(false))*)
    bench.tell("simSetCameraFov", Str("0"), Float32(60), Str(""), Bool(false))
    assertEqualsDouble(info(bench, "0").fov, 60, 1e-4)
    assertEqualsDouble(number("simGetFocalLength"), 23.76 / 2 / math.tan(math.toRadians(30)), 1e-4)
    set("simSetFocalLength", Float32(50))
    assertEqualsDouble(info(bench, "0").fov, math.toDegrees(2 * math.atan(23.76 / 100)), 1e-4)
    set("simSetPresetFilmbackSettings", Str("Full Frame DSLR"))
    assertEqualsDouble(info(bench, "0").fov, math.toDegrees(2 * math.atan(0.36)), 1e-4)
    set("simSetPresetLensSettings", Str("12mm Prime f/2.8"))
    set("simSetPresetLensSettings", Str("no such lens"))
    assertEqualsDouble(number("simGetFocalLength"), 12, 1e-6)
    val lens = bench.now[String]("simGetLensSettings", Str("0"), Str(""), Bool(false))
    assert(lens.startsWith("Name: 12mm Prime f/2.8;\n\t MinFocalLength: 12; \t MaxFocalLength: 12"), lens)
    assertEqualsDouble(
      bench.now[Float]("simSetFilmbackSettings", Float32(30), Float32(20), Str("0"), Str(""), Bool(false)),
      1.5,
      1e-6
    )
    set("simSetFocusDistance", Float32(123))
    set("simSetFocusAperture", Float32(4))
    assertEquals(number("simGetFocusDistance") -> number("simGetFocusAperture"), 123.0 -> 4.0)
    assertEqualsDouble(info(bench, "1").fov, 90, 1e-4)

  test("the projection's matrix maps the image's corner to the corner of clip space"):
    val rows              = info(Bench(), "0").proj_mat.matrix
    def of(p: Seq[Float]) = rows.map(row => row.zip(p).map(_ * _).sum)
    // Half the field of view to the right, and to the top of an image of 16:9.
    val Seq(x, y, _, w) = of(Seq(-1f, 1f, -9f / 16, 1f)): @unchecked
    assertEqualsFloat(x / w, 1f, 1e-5f)
    assertEqualsFloat(y / w, 1f, 1e-5f)

  test("distortion parameters are kept by their names"):
    val bench = Bench()
    bench.tell("simSetDistortionParam", Str("0"), Str("K2"), Float32(0.5f), Str(""), Bool(false))
    assertEquals(
      bench.now[Seq[Float]]("simGetDistortionParams", Str("front_center"), Str(""), Bool(false)),
      Seq(0f, 0.5f, 0f, 0f, 0f)
    )
    val refusal = bench.error("simSetDistortionParam", Str("0"), Str("K9"), Float32(1), Str(""), Bool(false))
    assert(refusal.contains("K1, K2, K3, P1, P2"), refusal)

  test("missing cameras are refused by name"):
    val bench = Bench()
    assert(bench.error(
      "simGetCameraInfo",
      Str("nose"),
      Str(""),
      Bool(false)
    ).contains("No camera with name nose"))
    assert(bench.error("simGetCameraInfo", Str("0"), Str(""), Bool(true)).contains("No external camera"))

  test("a camera keeps its detection filters"):
    val bench = Bench()
    for mesh <- Seq("Car*", "Tree*") do
      bench.tell("simAddDetectionFilterMeshName", Str("0"), Int32(0), Str(mesh), Str(""), Bool(false))
    bench.tell("simSetDetectionFilterRadius", Str("0"), Int32(0), Float32(500), Str(""), Bool(false))
    assertEquals(
      bench.simulation.cameras.detection(0, "front_center", 0),
      DetectionFilter(Set("Car*", "Tree*"), 500)
    )
    bench.tell("simClearDetectionMeshNames", Str("0"), Int32(0), Str(""), Bool(false))
    assertEquals(bench.simulation.cameras.detection(0, "front_center", 0).meshes, Set.empty)
    assert(bench.error(
      "simClearDetectionMeshNames",
      Str("0"),
      Int32(99),
      Str(""),
      Bool(false)
    ).contains("0 to 9"))
