package skein.simulator

import scala.io.Source
import skein.airsim.VehicleSettings
import skein.airsim.wire.*
import upack.*
import upickle.default.writeMsg

/** Functions that Cosys-AirSim's published client calls differently from AirSim's. `list_methods.py` writes
  * `methods.txt` from the client itself; [[CosysClientLiveSuite]] checks that.
  */
class CosysMethodsSuite extends munit.FunSuite:
  private val front: Msg = Str("front_center")
  private val none: Msg  = Str("")

  test("every function of Cosys-AirSim's client exists, with as many arguments as it sends"):
    val source = Source.fromResource("cosys-python/methods.txt")
    val called =
      try source.getLines().map(_.split(' ')).map(words => words(0) -> words(1).toInt).toVector
      finally source.close()
    assertEquals(called.size, 156)
    for (name, arity) <- called do
      assert(Simulation.named.get(name).exists(_.exists(_.arity == arity)), s"$name $arity")

  test("camera functions take no `external`, and an annotation's name after an image type"):
    val bench = Bench(Seq("A"))
    val image = writeMsg(ImageRequest("0", 0, pixels_as_float = false, compress = true))
    assertEquals(bench.now[Seq[ImageResponse]]("simGetImages", Arr(image), none).size, 1)
    val (ours, theirs) = (
      bench.now[Array[Byte]]("simGetImage", front, Int32(0), none, Bool(false)),
      bench.now[Array[Byte]]("simGetImage", front, Int32(0), none, none)
    )
    assertEquals(theirs.toSeq, ours.toSeq)
    bench.tell("simAddDetectionFilterMeshName", front, Int32(0), Str("*"), none, none)
    assert(bench.answerOf(bench.call("simGetDetections", front, Int32(0), none, none)).isRight)
    bench.tell("simSetCameraFov", front, Float32(60), none)
    assertEqualsDouble(bench.now[CameraInfo]("simGetCameraInfo", front, none).fov, 60, 0.01)
    assertEqualsDouble(
      bench.now[Float]("simSetFilmbackSettings", Float32(36), Float32(24), front, none),
      1.5,
      0.01
    )
    assert(bench.error("simGetImage", front, Int32(0), none, Int32(3)).contains("std::bad_cast"))
    assert(bench.error("simGetImage", front, Int32(0)).contains("invalid number of arguments"))

  test("an object's pose is only available in NED"):
    val bench = Bench(Seq("A"))
    val pose  = bench.now[Pose]("simGetObjectPose", Str("A"), Bool(true))
    assertEquals(pose, bench.now[Pose]("simGetObjectPose", Str("A")))
    assert(bench.error("simGetObjectPose", Str("A"), Bool(false)).contains("NED alone"))
    assertEquals(
      bench.now[Seq[Pose]]("simListInstanceSegmentationPoses", Bool(true), Bool(false)).size,
      bench.now[Seq[String]]("simListInstanceSegmentationObjects").size
    )

  test("a camera rig reports its state, and a multirotor has no such state"):
    val bench = Bench.of(VehicleSettings("Cam", vehicleType = "ComputerVision"), VehicleSettings("Drone"))
    val state = bench.now[ComputerVisionState]("getComputerVisionState", Str("Cam"))
    assertEquals(state.timestamp, bench.simulation.world.now)
    assert(bench.error("getComputerVisionState", Str("Drone")).contains("'Drone' is a multirotor"))

  test("AirSim's own setSafety answers that there is no safety evaluation"):
    val told = bench0.error("setSafety", SampleCalls.params("setSafety")*)
    assert(told.contains("requires safety_eval_ptr_ to be set first"), told)

  private def bench0 = Bench(Seq("A"))

  test("setting a missing object's pose to NaN answers false"):
    val bench   = Bench(Seq("A"))
    val nowhere = upickle.default.readBinary[Pose](
      bench.answerOf(bench.call("simGetObjectPose", Str("Nothing"))).toOption.get
    )
    assert(nowhere.position.x_val.isNaN)
    assertEquals(bench.now[Boolean]("simSetObjectPose", Str("Nothing"), writeMsg(nowhere), Bool(true)), false)
    assert(
      bench.error(
        "simSetObjectPose",
        Str("A"),
        writeMsg(nowhere),
        Bool(true)
      ).contains("must be finite numbers")
    )

  test("moveToGPS uses its goal in single precision, as AirSim does"):
    val bench = Bench().hovering(-20)
    // 47.64157 is 47.641571 as a 32-bit number, and 0.1 m of a degree more is rounded to this number too.
    def fly(latitude: Double) =
      val begun = Bench().hovering(-20)
      begun.call(
        "moveToGPS",
        Float64(latitude),
        Float64(-122.140165),
        Float32(142),
        Float32(5),
        Float32(60),
        Int32(0),
        writeMsg(YawMode.Still),
        Float32(-1),
        Float32(1),
        Str("")
      ): Unit
      begun.pass(5)
      begun.position()
    assertEquals(fly(47.64157), fly(47.64157f.toDouble))
    assertNotEquals(fly(47.64157), bench.position())
