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
