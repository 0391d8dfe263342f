package skein.record

import skein.policy.{Action, Yaw}
import skein.units.*

class ActionCellsSuite extends munit.FunSuite:
  private val yaws   = Seq(Yaw.Still, Yaw.Towards(Radians(-2.5)), Yaw.Turning(0.7), Yaw.Forward)
  private val place  = Vector3(1.25, -3.5, -20.75)
  private val others =
    Seq(Action.Attitude(Radians(0.1), Radians(-0.2), Radians(3), 0.6), Action.Hover, Action.Land)
  private val turned = yaws.flatMap: yaw =>
    Seq(
      Action.Velocity(place, yaw),
      Action.VelocityAt(4.5, -6.25, Metres(-20), yaw),
      Action.Position(place, MetresPerSecond(3.5), yaw),
      Action.Turn(yaw)
    )

  for action <- turned ++ others do
    test(s"$action is read back as it was"):
      assertEquals(ActionCells.of(action).action, action)

  test("flight along a heading is read back as its velocity"):
    for yaw <- yaws do
      val along = Action.Along(Radians(0.5), MetresPerSecond(4), Metres(-20), yaw)
      assertEquals(ActionCells.of(along).action, along.byVelocity)

  test("components that an action lacks are zero, so that equal actions have equal digests"):
    def numbers(action: Action) =
      val cells = ActionCells.of(action)
      Seq(cells.x, cells.y, cells.z, cells.amount, cells.yaw)
    for action <- Seq(Action.Hover, Action.Land, Action.Turn(Yaw.Still), Action.Turn(Yaw.Forward)) do
      assertEquals(numbers(action), Seq(0.0, 0.0, 0.0, 0.0, 0.0), action.toString)
    assertEquals(numbers(Action.Velocity(place, Yaw.Still)), Seq(1.25, -3.5, -20.75, 0, 0))
    assertEquals(numbers(Action.VelocityAt(1, 2, Metres(3), Yaw.Turning(0.5))), Seq(1.0, 2, 3, 0, 0.5))
