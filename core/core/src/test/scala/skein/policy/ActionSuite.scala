package skein.policy

import skein.units.*

/** Headings and speeds of actions, which some policies need. */
class ActionSuite extends munit.FunSuite:
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

  test("the heading of an action is that of its velocity, else that of its yaw, else the previous heading"):
    assertEquals(Action.Velocity(Vector3(0, 0.5, -3)).headingRad(0.7), math.Pi / 2)
    assertEquals(Action.VelocityAt(-0.01, 0, down).headingRad(0.7), math.Pi)
    assertEquals(Action.Turn(Yaw.Towards(Radians(0.3))).headingRad(0.7), 0.3)
    assertEquals(Action.Attitude(Radians(0.1), Radians(0.2), Radians(0.3), 0.5).headingRad(0.7), 0.3)
    assertEquals(Action.Along(Radians(7), MetresPerSecond(0), down).headingRad(0.7), 7.0)
    for action <- still do assertEquals(action.headingRad(0.7), 0.7, action.toString)

  test("an action with a velocity has its horizontal speed, any other action has speed 0"):
    assertEquals(Action.Velocity(Vector3(3, 4, -12)).speed, MetresPerSecond(5))
    assertEquals(Action.VelocityAt(3, -4, down).speed, MetresPerSecond(5))
    assertEquals(Action.Along(Radians(7), MetresPerSecond(5), down).speed, MetresPerSecond(5))
    for action <- still do assertEquals(action.speed, MetresPerSecond(0), action.toString)

  test("flight along a heading becomes a velocity with its altitude and yaw; other actions stay unchanged"):
    val along = Action.Along(Radians(0.5), MetresPerSecond(4), down, Yaw.Forward)
    assertEquals(
      along.byVelocity,
      Action.VelocityAt(4 * StrictMath.cos(0.5), 4 * StrictMath.sin(0.5), down, Yaw.Forward)
    )
    for action <- still do assertEquals(action.byVelocity, action)
