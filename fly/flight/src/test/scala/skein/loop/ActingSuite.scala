package skein.loop

import skein.policy.{Action, Yaw}
import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.Setpoint

/** What an action is taken for where headings and speeds are asked for, and what is foreseen of its vehicle.
  */
class ActingSuite extends munit.FunSuite:
  private val down  = Metres(-20)
  private val place = Action.Position(Vector3(1, 2, -20), MetresPerSecond(4))
  private val still = Seq(
    Action.Velocity(Vector3(0, 0, -2)),
    Action.VelocityAt(0, 0, down),
    place,
    Action.Turn(Yaw.Still),
    Action.Hover,
    Action.Land
  )

  test(
    "its heading is where it flies, however slowly, or else where " +
      "it looks; what says neither keeps the one before"
  ):
    assertEquals(Acting.headingRad(Action.Velocity(Vector3(0, 0.5, -3)), 0.7), math.Pi / 2)
    assertEquals(Acting.headingRad(Action.VelocityAt(-0.01, 0, down), 0.7), math.Pi)
    assertEquals(Acting.headingRad(Action.Turn(Yaw.Towards(Radians(0.3))), 0.7), 0.3)
    assertEquals(Acting.headingRad(Action.Attitude(Radians(0.1), Radians(0.2), Radians(0.3), 0.5), 0.7), 0.3)
    for action <- still do assertEquals(Acting.headingRad(action, 0.7), 0.7, action.toString)

  test("only what flies with a velocity has a speed: the horizontal one"):
    assertEquals(Acting.speed(Action.Velocity(Vector3(3, 4, -12))), MetresPerSecond(5))
    assertEquals(Acting.speed(Action.VelocityAt(3, -4, down)), MetresPerSecond(5))
    for action <- still do assertEquals(Acting.speed(action), MetresPerSecond(0), action.toString)

  test("a vehicle that hovers or turns is foreseen to stay, one that lands to sink as AirSim sinks"):
    val stays = Setpoint.velocity(0, 0, 0)
    assertEquals(Acting.guidance(Action.Hover), stays)
    assertEquals(Acting.guidance(Action.Turn(Yaw.Forward)), stays)
    assertEquals(Acting.guidance(Action.Turn(Yaw.Towards(Radians(0.3)))), stays.withYaw(0.3))
    assertEquals(Acting.guidance(Action.Turn(Yaw.Turning(0.2))), stays.withYawRate(0.2))
    assertEquals(Acting.guidance(Action.Land), Setpoint.velocity(0, 0, 0.2))

  test(
    "it looks where it flies only above half a metre a second, " +
      "the vertical not counted where an altitude is held"
  ):
    def yaw(north: Double, east: Double) =
      (
        Acting.guidance(Action.VelocityAt(north, east, down, Yaw.Forward)),
        Setpoint.velocityZ(north, east, -20)
      )
    for (north, east) <- Seq((0.0, 0.0), (0.5, 0.0)) do
      val (foreseen, without) = yaw(north, east)
      assertEquals(foreseen, without)
    val (foreseen, without) = yaw(0, 0.6)
    assertEquals(foreseen, without.withYaw(math.Pi / 2))

  private def towards(wayNed: Vector3, yaw: Yaw = Yaw.Still): Setpoint =
    val here = Vector3(10, 5, -20)
    Acting
      .guidance(Action.Position(here + wayNed, MetresPerSecond(4), yaw))
      .setpoint(Kinematics(here, Vector3.Zero, Quaternion.Identity, Vector3.Zero))

  test("on its way to a place it flies at its speed, and stands within half a metre of it"):
    assertEquals(towards(Vector3(100, 0, 0)), Setpoint.velocity(4, 0, 0))
    assertEquals(towards(Vector3(0, -100, 0), Yaw.Forward), Setpoint.velocity(0, -4, 0).withYaw(-math.Pi / 2))
    assertEquals(towards(Vector3(0.3, 0, 0)), Setpoint.velocity(0, 0, 0))

  test(
    "it climbs to a place once the point that AirSim aims at, 0.6 s ahead, lies more than half a metre above"
  ):
    assertEquals(towards(Vector3(10, 0, -2)).third, 0.0)
    assert(towards(Vector3(10, 0, -2.5)).third < -0.8, towards(Vector3(10, 0, -2.5)).toString)
