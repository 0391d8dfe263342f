package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Predicts constant velocity, for vehicles whose commands are unknown. */
object ConstantVelocity extends VehicleModel[Kinematics]:
  def start(seen: Kinematics): Kinematics = seen

  def advanced(state: Kinematics, setpoint: Setpoint, span: Span): Kinematics =
    state.copy(positionNed = state.positionNed + state.velocityNed * span.toSeconds)

  def corrected(state: Kinematics, seen: Kinematics, sinceSeen: Span): Kinematics = seen

  def kinematics(state: Kinematics): Kinematics = state

/** Predicts constant speed, and the turn rate between the last two readings; for vehicles whose commands are
  * unknown.
  */
object ConstantTurn extends VehicleModel[ConstantTurn.Turning]:

  /** State of a turning vehicle.
    *
    * @param turnRateRadps turn rate of the horizontal velocity, positive from north towards east
    * @param seen the last reading
    */
  final case class Turning(now: Kinematics, turnRateRadps: Double, seen: Kinematics)

  def start(seen: Kinematics): Turning = Turning(seen, 0, seen)

  /** Integrates along the circular arc in closed form. */
  def advanced(state: Turning, setpoint: Setpoint, span: Span): Turning =
    val velocity = state.now.velocityNed
    val t        = span.toSeconds
    val angle    = state.turnRateRadps * t
    // sin a / a and (1 − cos a) / a, by their series where a is too small to divide by.
    val along  = if math.abs(angle) < 1e-6 then 1.0 else StrictMath.sin(angle) / angle
    val across = if math.abs(angle) < 1e-6 then angle / 2 else (1 - StrictMath.cos(angle)) / angle
    val moved  = Vector3(
      (velocity.x * along - velocity.y * across) * t,
      (velocity.x * across + velocity.y * along) * t,
      velocity.z * t
    )
    val (cos, sin) = (StrictMath.cos(angle), StrictMath.sin(angle))
    val turned = Vector3(velocity.x * cos - velocity.y * sin, velocity.x * sin + velocity.y * cos, velocity.z)
    state.copy(now = state.now.copy(positionNed = state.now.positionNed + moved, velocityNed = turned))

  def corrected(state: Turning, seen: Kinematics, sinceSeen: Span): Turning =
    val (before, after) = (state.seen.velocityNed, seen.velocityNed)
    val turned          =
      StrictMath.atan2(before.x * after.y - before.y * after.x, before.x * after.x + before.y * after.y)
    Turning(seen, if sinceSeen > Span.Zero then turned / sinceSeen.toSeconds else state.turnRateRadps, seen)

  def kinematics(state: Turning): Kinematics = state.now
