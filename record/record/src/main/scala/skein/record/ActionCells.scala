package skein.record

import skein.policy.{Action, Yaw}
import skein.units.*

/** An action's columns in a recording: see [[FieldColumns]]. */
private[record] final case class ActionCells(
    kind: String,
    x: Double,
    y: Double,
    z: Double,
    amount: Double,
    yawMode: String,
    yaw: Double
):
  def action: Action = kind match
    case "Velocity"   => Action.Velocity(Vector3(x, y, z), turning)
    case "VelocityAt" => Action.VelocityAt(x, y, Metres(z), turning)
    case "Position"   => Action.Position(Vector3(x, y, z), MetresPerSecond(amount), turning)
    case "Turn"       => Action.Turn(turning)
    case "Attitude"   => Action.Attitude(Radians(x), Radians(y), Radians(z), amount)
    case "Land"       => Action.Land
    case _            => Action.Hover

  private def turning: Yaw = yawMode match
    case "Towards" => Yaw.Towards(Radians(yaw))
    case "Turning" => Yaw.Turning(yaw)
    case "Forward" => Yaw.Forward
    case _         => Yaw.Still

private[record] object ActionCells:
  def of(action: Action): ActionCells = action match
    case Action.Velocity(velocity, yaw)            => cells(action, velocity, 0, yaw)
    case Action.VelocityAt(north, east, down, yaw) => cells(action, Vector3(north, east, down.value), 0, yaw)
    case along: Action.Along                       => of(along.byVelocity)
    case Action.Position(position, speed, yaw)     => cells(action, position, speed.value, yaw)
    case Action.Turn(yaw)                          => cells(action, Vector3.Zero, 0, yaw)
    case Action.Attitude(roll, pitch, yaw, thrust) =>
      cells(action, Vector3(roll.value, pitch.value, yaw.value), thrust, Yaw.Still)
    case Action.Hover | Action.Land => cells(action, Vector3.Zero, 0, Yaw.Still)

  private def cells(action: Action, numbers: Vector3, amount: Double, yaw: Yaw): ActionCells =
    val turn = yaw match
      case Yaw.Towards(heading)    => heading.value
      case Yaw.Turning(rate)       => rate
      case Yaw.Still | Yaw.Forward => 0.0
    ActionCells(action.productPrefix, numbers.x, numbers.y, numbers.z, amount, yaw.productPrefix, turn)
