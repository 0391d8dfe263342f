package skein.policy

import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.Setpoint

/** Predictions of a vehicle under an action. */
class ActionGuidanceSuite extends munit.FunSuite:
  private val down = Metres(-20)

  test("a vehicle that hovers or turns is predicted to stay, and one that lands to descend as AirSim does"):
    val stays = Setpoint.velocity(0, 0, 0)
    assertEquals(ActionGuidance.of(Action.Hover), stays)
    assertEquals(ActionGuidance.of(Action.Turn(Yaw.Forward)), stays)
    assertEquals(ActionGuidance.of(Action.Turn(Yaw.Towards(Radians(0.3)))), stays.withYaw(0.3))
    assertEquals(ActionGuidance.of(Action.Turn(Yaw.Turning(0.2))), stays.withYawRate(0.2))
    assertEquals(ActionGuidance.of(Action.Land), Setpoint.velocity(0, 0, 0.2))

  test("a vehicle turns towards its direction of flight only above 0.5 m/s of horizontal speed"):
    def yaw(north: Double, east: Double) =
      (
        ActionGuidance.of(Action.VelocityAt(north, east, down, Yaw.Forward)),
        Setpoint.velocityZ(north, east, -20)
      )
    for (north, east) <- Seq((0.0, 0.0), (0.5, 0.0)) do
      val (foreseen, without) = yaw(north, east)
      assertEquals(foreseen, without)
    val (foreseen, without) = yaw(0, 0.6)
    assertEquals(foreseen, without.withYaw(math.Pi / 2))

  private def towards(wayNed: Vector3, yaw: Yaw = Yaw.Still): Setpoint =
    val here = Vector3(10, 5, -20)
    ActionGuidance
      .of(Action.Position(here + wayNed, MetresPerSecond(4), yaw))
      .setpoint(Kinematics(here, Vector3.Zero, Quaternion.Identity, Vector3.Zero))

  test("on its way to a position a vehicle flies at its speed, and stops within half a metre of it"):
    assertEquals(towards(Vector3(100, 0, 0)), Setpoint.velocity(4, 0, 0))
    assertEquals(towards(Vector3(0, -100, 0), Yaw.Forward), Setpoint.velocity(0, -4, 0).withYaw(-math.Pi / 2))
    assertEquals(towards(Vector3(0.3, 0, 0)), Setpoint.velocity(0, 0, 0))

  test("a vehicle climbs to a position once AirSim's point 0.6 s ahead is more than half a metre above it"):
    assertEquals(towards(Vector3(10, 0, -2)).third, 0.0)
    assert(towards(Vector3(10, 0, -2.5)).third < -0.8, towards(Vector3(10, 0, -2.5)).toString)
