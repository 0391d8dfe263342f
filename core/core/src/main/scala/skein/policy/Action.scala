package skein.policy

import skein.units.*

/** An action of a vehicle. World frame NED, metres, m/s, radians from north towards east. An action lasts
  * until the next one, or until its duration ends; then the vehicle holds its position.
  */
enum Action:
  case Velocity(velocityNed: Vector3, yaw: Yaw = Yaw.Still)

  /** Flies with this horizontal velocity and holds an altitude.
    *
    * @param down altitude, negative above the origin
    */
  case VelocityAt(northMps: Double, eastMps: Double, down: Metres, yaw: Yaw = Yaw.Still)

  /** Flies to a position, no faster than `speed`, and stays there. */
  case Position(positionNed: Vector3, speed: MetresPerSecond, yaw: Yaw = Yaw.Still)

  /** Holds its position, and turns as `yaw` states. */
  case Turn(yaw: Yaw)

  /** Holds roll, pitch and yaw angles.
    *
    * @param thrust share of full thrust, 0 to 1
    */
  case Attitude(roll: Radians, pitch: Radians, yaw: Radians, thrust: Double)

  case Hover

  /** Descends until it stands on the ground. */
  case Land

  /** Flies on a heading and holds an altitude.
    *
    * @param heading heading, any number of turns
    * @param down altitude, negative above the origin
    */
  case Along(heading: Radians, speed: MetresPerSecond, down: Metres, yaw: Yaw = Yaw.Still)

object Action:
  /** Smallest speed of a velocity that has a direction, m/s. */
  val LeastMps: Double = 1e-9

  extension (action: Action)
    /** The heading of the action's velocity, or else of its yaw, or else the previous heading, rad. Other
      * vehicles receive it as the last commanded heading.
      */
    def headingRad(beforeRad: Double): Double = action match
      case Action.Velocity(velocity, _)         => along(velocity.x, velocity.y, beforeRad)
      case Action.VelocityAt(north, east, _, _) => along(north, east, beforeRad)
      case Action.Along(heading, _, _, _)       => heading.value
      case Action.Turn(Yaw.Towards(heading))    => heading.value
      case Action.Attitude(_, _, yaw, _)        => yaw.value
      case Action.Position(_, _, _) | Action.Turn(_) | Action.Hover | Action.Land => beforeRad

    /** The horizontal speed, m/s; 0 for actions without one. */
    def speed: MetresPerSecond = MetresPerSecond(action match
      case Action.Velocity(velocity, _)         => StrictMath.hypot(velocity.x, velocity.y)
      case Action.VelocityAt(north, east, _, _) => StrictMath.hypot(north, east)
      case Action.Along(_, along, _, _)         => along.value
      case _                                    => 0)

    /** Converts flight along a heading to a velocity; returns any other action unchanged. */
    def byVelocity: Action = action match
      case Action.Along(heading, speed, down, yaw) =>
        val (cos, sin) = (StrictMath.cos(heading.value), StrictMath.sin(heading.value))
        Action.VelocityAt(speed.value * cos, speed.value * sin, down, yaw)
      case other => other

  /** Whether every component of an action, or of a part of one, is finite, including its speed; false for
    * null.
    */
  private[skein] def isFinite(part: Any): Boolean = part match
    case null                                           => false
    case number: Double                                 => number.isFinite
    case action: Action if !action.speed.value.isFinite => false
    case parts: Product                                 => parts.productIterator.forall(isFinite)
    case _                                              => true

  private def along(northMps: Double, eastMps: Double, beforeRad: Double) =
    if StrictMath.hypot(northMps, eastMps) < LeastMps then beforeRad
    else StrictMath.atan2(eastMps, northMps)

/** How an action controls the vehicle's yaw. */
enum Yaw:
  case Still

  case Towards(heading: Radians)

  /** Turns at this rate, rad/s, clockwise seen from above. */
  case Turning(radiansPerSecond: Double)

  case Forward
