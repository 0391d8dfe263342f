package skein.simulator

import skein.airsim.VehicleSettings
import skein.airsim.wire.*
import skein.units.*
import upack.{Bool, Float32, Str}
import upickle.default.writeMsg

/** API control, and its effect on a vehicle in flight when it is taken or released: as in AirSim's
  * SimpleFlight.
  */
class ControlSuite extends munit.FunSuite:

  private val there                         = Str("")
  private def landed(bench: Bench): Boolean =
    bench.now[MultirotorReading]("getMultirotorState", there).landed_state == 0
  private def control(bench: Bench, on: Boolean): Unit = bench.tell("enableApiControl", Bool(on), there)
  private def arm(bench: Bench, on: Boolean): Boolean  = bench.now[Boolean]("armDisarm", Bool(on), there)
  private def velocity(bench: Bench): Vector3          = bench.kinematics().linear_velocity.toVector
  private def thrusts(bench: Bench): Seq[Float]        =
    bench.now[RotorStates]("getRotorStates", there).rotors.map(_.thrust)

  test("a hovering vehicle whose API control is taken again falls, counts as landed and is not caught"):
    val bench = Bench().hovering(-20)
    bench.pass(1)
    assert(!landed(bench))
    control(bench, on = true)
    bench.pass(0.003)
    assert(landed(bench), "AirSim takes it for landed within a step")
    bench.pass(0.297)
    assertEqualsDouble(velocity(bench).z, 2.5, 0.1)
    assert(bench.error(
      "takeoff",
      Float32(20),
      there
    ).contains("Cannot perform takeoff because vehicle is already moving"))
    bench.pass(20)
    assertEqualsDouble(bench.position().z, 0, 0.05)

  test("a moving vehicle whose API control is taken again is caught when its last goal is 60 ms old"):
    val bench = Bench().hovering(-20)
    bench.velocity(5, 0, 0, 2)
    bench.pass(2.03)
    control(bench, on = true)
    bench.pass(0.02)
    assert(!landed(bench))
    assert(thrusts(bench).sum < 2, "idle")
    val caught = bench.position()
    bench.pass(20)
    assert(!landed(bench))
    assert((bench.position() - caught).norm < 0.3, s"${bench.position()}, caught at $caught")

  test("a vehicle whose API control is released falls level until it is taken again and used"):
    val bench = Bench().hovering(-20)
    bench.velocity(5, 0, 0, 3)
    bench.pass(3)
    control(bench, on = false)
    bench.pass(0.5)
    assert(velocity(bench).z > 3.5, s"${velocity(bench)}")
    // An absent remote control commands level attitude: the tilt that moved it is gone.
    val q = bench.kinematics().orientation
    assertEqualsDouble(2 * math.asin(math.hypot(q.x_val, q.y_val)), 0, 0.02)
    control(bench, on = true)
    bench.velocity(0, 0, 0, 5)
    bench.pass(5)
    assert(velocity(bench).norm < 0.3, s"${velocity(bench)}")

  test("arming an armed vehicle changes nothing, even in flight"):
    def flight(again: Boolean) =
      val bench = Bench().hovering(-20)
      bench.velocityZ(5, 0, -20, 1)
      bench.pass(1.03)
      if again then assert(arm(bench, on = true))
      bench.pass(0.02)
      if again then assert(arm(bench, on = true))
      bench.pass(3)
      if again then assert(arm(bench, on = true))
      bench.pass(3)
      bench.position()
    assertEquals(flight(again = true), flight(again = false))

  test("a vehicle is armed after the start and after a reset: its rotors idle at 173 rad/s, 0.28 N each"):
    val bench = Bench()
    for _ <- 1 to 2 do
      bench.pass(0.2)
      val rotors = bench.now[RotorStates]("getRotorStates", there).rotors
      rotors.foreach: rotor =>
        assertEqualsDouble(rotor.thrust, 0.2786, 0.0005)
        assertEqualsDouble(rotor.speed, 172.96, 0.05)
      control(bench, on = true)
      assert(arm(bench, on = false), "it was armed")
      assert(!arm(bench, on = false), "it no longer is")
      bench.pass(0.2)
      assert(thrusts(bench).sum < 1e-3)
      bench.tell("reset")

  test("only the API in control arms and disarms"):
    val bench = Bench()
    assert(!arm(bench, on = true))
    assert(!arm(bench, on = false))

  test("a vehicle whose settings say so starts disarmed"):
    val bench = Bench.of(VehicleSettings("Evader", armed = false))
    bench.pass(0.2)
    assertEquals(thrusts(bench), Seq(0f, 0f, 0f, 0f))
    control(bench, on = true)
    assert(!arm(bench, on = false))
    assert(arm(bench, on = true))
    bench.pass(0.2)
    assert(thrusts(bench).sum > 1)

  private def place(bench: Bench, at: Vector3): Unit =
    bench.tell(
      "simSetVehiclePose",
      writeMsg(Pose(Vector3r(at), bench.kinematics().orientation)),
      Bool(true),
      there
    )

  test("setting a pose keeps a vehicle's velocity and goal"):
    val moved, left = Bench().hovering(-20)
    for bench <- Seq(moved, left) do
      bench.velocityZ(5, 0, -20, 10)
      bench.pass(2)
    val from = moved.position()
    val here = velocity(moved)
    place(moved, from + Vector3(0, 100, 0))
    assertEquals(velocity(moved), here)
    assert((moved.position() - from - Vector3(0, 100, 0)).norm < 1e-5)
    moved.pass(4.5)
    left.pass(4.5)
    assert((moved.position() - left.position() - Vector3(0, 100, 0)).norm < 1e-3)

  test("after setting a pose, a vehicle that held a position flies back, and one that stood falls"):
    val held = Bench().hovering(-20)
    held.pass(1)
    place(held, Vector3(3, 0, -20))
    held.pass(20)
    assert((held.position() - Vector3(0, 0, -20)).norm < 0.1, s"${held.position()}")
    val fallen = Bench().ready()
    place(fallen, Vector3(0, 0, -5))
    fallen.pass(0.5)
    assert(velocity(fallen).z > 3, s"${velocity(fallen)}")
    fallen.pass(5)
    assertEqualsDouble(fallen.position().z, 0, 0.05)

  test("skeinHoverAt needs API control and a position above the ground"):
    def hoverAt(bench: Bench, down: Double) = bench.error(
      "skeinHoverAt",
      writeMsg(Pose(Vector3r(Vector3(0, 0, down)), Quaternionr(Quaternion.Identity))),
      there
    )
    assert(hoverAt(Bench(), -5).contains("only a vehicle under api control can hover"))
    assert(hoverAt(Bench().ready(), 0).contains("expected a place above the ground, got z = 0.0 m"))

  test(
    "position hold drifts when the yaw is not 0, as in AirSim: at 99 degrees it does not come to rest nearby"
  ):
    def wandering(yawDeg: Double) =
      val bench = Bench().ready()
      val yaw   = math.toRadians(yawDeg)
      val pose  =
        Pose(Vector3r(0, 0, -20), Quaternionr(math.cos(yaw / 2).toFloat, 0, 0, math.sin(yaw / 2).toFloat))
      bench.tell("skeinHoverAt", writeMsg(pose), there)
      bench.velocity(2, 1, 0, 2)
      bench.pass(2.06)
      val held = bench.position()
      bench.pass(60)
      (bench.position() - held).norm
    assert(wandering(0) < 0.05, s"${wandering(0)} m at 0 degrees")
    assert(wandering(99) > 0.5, s"${wandering(99)} m at 99 degrees")
