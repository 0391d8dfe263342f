package skein.airsim

import skein.airsim.wire.YawMode
import skein.units.Radians

/** What a move does with the vehicle's yaw. */
enum Yaw:
  /** Keeps it: rate zero. */
  case Still

  /** Turns to this heading, from north towards east. */
  case Towards(heading: Radians)

  /** Turns at this rate, rad/s, clockwise seen from above. */
  case Turning(radiansPerSecond: Double)

  /** Turns into the direction of travel. */
  case Forward

  private[skein] def mode: YawMode = this match
    case Still            => YawMode.Still
    case Towards(heading) => YawMode(is_rate = false, math.toDegrees(heading.value).toFloat)
    case Turning(rate)    => YawMode(is_rate = true, math.toDegrees(rate).toFloat)
    case Forward          => YawMode(is_rate = false, 0)

  /** AirSim's drivetrain: 1 forward only, 0 any direction. */
  private[skein] def drivetrain: Int = if this == Forward then 1 else 0
