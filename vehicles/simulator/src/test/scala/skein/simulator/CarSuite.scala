package skein.simulator

import skein.airsim.VehicleSettings
import skein.airsim.wire.*
import skein.scene.{Placement, Scene, SceneObject, Shape}
import skein.units.*
import upack.{Bool, Obj, Str}
import upickle.default.writeMsg

/** AirSim's car API, in a world with a car and a multirotor. */
class CarSuite extends munit.FunSuite:
  private val car = Str("Car")

  private def bench(scene: Scene = Scene.Empty, yaw: Double = 0): Bench =
    val made = Bench(
      Seq("Car", "Drone"),
      Seq(
        VehicleSettings("Car", Vector3(10, 0, 0), Radians(yaw), vehicleType = "physxcar"),
        VehicleSettings("Drone")
      ),
      scene = scene
    )
    made.tell("enableApiControl", Bool(true), car)
    made

  private def drive(bench: Bench, controls: CarControls): Unit =
    bench.tell("setCarControls", writeMsg(controls), car)
  private def state(bench: Bench): CarState = bench.now[CarState]("getCarState", car)

  test("a car drives where it is steered, on the simulator's clock"):
    val world = bench()
    assertEquals(state(world).gear, 0)
    drive(world, CarControls(throttle = 0.5f))
    world.pass(3)
    val ahead = state(world)
    assertEqualsDouble(ahead.speed.toDouble, (1.0489 / 4 - 0.015) * 9.80665 * 3, 0.1)
    assertEquals((ahead.gear, ahead.handbrake), (1, false))
    assert(ahead.rpm > 500 && ahead.rpm < ahead.maxrpm, ahead.rpm)
    assertEquals(ahead.kinematics_estimated.position.toVector.y, 0.0)
    drive(world, CarControls(throttle = 0.2f, steering = 1))
    world.pass(1)
    val turning = state(world).kinematics_estimated
    assert(turning.position.y_val > 0.1, turning)
    assert(turning.angular_velocity.z_val > 0.3 && turning.linear_acceleration.y_val > 1, turning)
    assertEquals(state(world).timestamp.toNanos, world.simulation.world.now.toNanos)

  test("readings between two steps of physics agree with the next step"):
    val world = bench(yaw = 1)
    drive(world, CarControls(throttle = 1, steering = -0.3f))
    world.pass(2)
    val before = world.kinematics("Car")
    world.pass(0.001)
    val after = world.kinematics("Car")
    val way   = (after.position.toVector - before.position.toVector).norm
    assertEqualsDouble(way, before.linear_velocity.toVector.norm * 0.001, 1e-5)

  test("the reverse gear drives backwards for any sign of the throttle, and the handbrake stops the car"):
    for throttle <- Seq(0.5f, -0.5f) do
      val world = bench()
      drive(world, CarControls(throttle, is_manual_gear = true, manual_gear = -1))
      world.pass(2)
      assert(state(world).speed < -3 && state(world).gear == -1, state(world))
      drive(world, CarControls(handbrake = true))
      world.pass(2)
      assertEquals((state(world).speed, state(world).handbrake), (0f, true))

  test("without API control a car does not drive, and its controls are reset"):
    val world = bench()
    drive(world, CarControls(throttle = 1))
    assertEquals(world.now[CarControls]("getCarControls", car), CarControls(throttle = 1))
    world.tell("enableApiControl", Bool(false), car)
    assertEquals(world.now[CarControls]("getCarControls", car), CarControls())
    drive(world, CarControls(throttle = 1))
    world.pass(1)
    assertEquals(state(world).speed, 0f)

  test("controls with some keys keep the defaults of the others, and numbers may be whole"):
    val world = bench()
    world.tell("setCarControls", Obj(Str("throttle") -> upack.Int32(1)), car)
    assertEquals(world.now[CarControls]("getCarControls", car), CarControls(throttle = 1))
    assert(world.error("setCarControls", Str("fast"), car).contains("std::bad_cast"))
    assert(
      world.error("setCarControls", Obj(Str("throttle") -> upack.Float64(Double.NaN)), car).contains("finite")
    )

  test("a reset and a pose move a car, and it stands still while paused"):
    val world = bench()
    drive(world, CarControls(throttle = 1, steering = 0.2f))
    world.pass(2)
    world.tell("simPause", Bool(true))
    val stood = world.position("Car")
    world.pass(1)
    assertEquals(world.position("Car"), stood)
    world.tell("simContinueForTime", upack.Float64(0.1))
    assert((world.position("Car") - stood).norm > 0.5)
    world.tell("simPause", Bool(false))
    world.tell(
      "simSetVehiclePose",
      writeMsg(Pose(Vector3r(3, 4, -5), Quaternionr(Quaternion.ofYaw(2)))),
      Bool(true),
      car
    )
    val there = world.now[Pose]("simGetVehiclePose", car)
    assert((there.position.toVector - Vector3(3, 4, 0)).norm < 1e-5, there)
    assertEqualsDouble(there.orientation.toQuaternion.yawRad, 2, 1e-5)
    world.tell("reset")
    assertEquals(world.position("Car"), Vector3.Zero)
    assertEquals((state(world).speed, world.now[Boolean]("isApiControlEnabled", car)), (0f, false))

  test("a car stops at an obstacle, and reports the contact"):
    val wall = SceneObject(
      "Wall",
      Shape.Box(Vector3(0.5, 5, 1)),
      Placement(Vector3(30, 0, -1), Quaternion.Identity),
      0,
      None
    )
    val world = bench(Scene(Vector(wall)))
    drive(world, CarControls(throttle = 1))
    world.pass(6)
    assertEqualsDouble(world.position("Car").x + 10, 29.5 - 4.508 / 2, 0.1)
    val touched = world.now[CollisionInfo]("simGetCollisionInfo", car)
    assert(touched.has_collided && touched.object_name == "Wall", touched)
    drive(world, CarControls(throttle = -1))
    world.pass(1)
    assert(state(world).speed < -3, "it drives out again")

  test("a function of the other kind of vehicle is refused"):
    val world = bench()
    assert(world.error("getMultirotorState", car).contains("expected a multirotor, 'Car' is a car"))
    assert(world.error("takeoff", upack.Float32(20), car).contains("expected a multirotor"))
    assert(world.error("getCarState", Str("Drone")).contains("expected a car, 'Drone' is a multirotor"))

  test("sensors, cameras and lines of sight include a car"):
    val world = bench()
    world.pass(1)
    val imu = world.now[ImuData]("getImuData", Str(""), car)
    assertEqualsDouble(imu.linear_acceleration.z_val.toDouble, -9.80665, 1e-5)
    val camera = world.now[CameraInfo]("simGetCameraInfo", Str("3"), car, Bool(false))
    assertEquals(camera.pose.position.toVector, Vector3(0, -0.25, -1.75))
    assert(world.error("simGetCameraInfo", Str("bottom_center"), car, Bool(false)).contains("bottom_center"))
    val image =
      world.now[Array[Byte]]("simGetImage", Str("0"), upack.Int32(0), car, Bool(false))
    assert(image.length > 100)

  test("a car can be added while the simulator runs"):
    val world = bench()
    val pose  = writeMsg(Pose(Vector3r(0, 20, 0), Quaternionr(Quaternion.Identity)))
    assert(world.now[Boolean]("simAddVehicle", Str("Late"), Str("PhysXCar"), pose, Str("")))
    world.tell("enableApiControl", Bool(true), Str("Late"))
    world.tell("setCarControls", writeMsg(CarControls(throttle = 1)), Str("Late"))
    world.pass(1)
    assert(world.now[CarState]("getCarState", Str("Late")).speed > 3)
