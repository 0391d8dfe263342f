package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Predicts a [[DrivenCar]]. A setpoint that is not a velocity means "stand still". The angle of the front
  * wheels and the deflection of the tyres are missing in readings, and are simulated from reading to reading.
  */
final case class CarModel(driven: DrivenCar = DrivenCar()) extends VehicleModel[CarModel.Driving]:
  import CarModel.*

  def start(seen: Kinematics): Driving = corrected(Driving(driven.initial, seen), seen, Span.Zero)

  def advanced(driving: Driving, setpoint: Setpoint, span: Span): Driving =
    val (north, east) =
      if setpoint.horizontal == HorizontalMode.Velocity then (setpoint.first, setpoint.second) else (0.0, 0.0)
    var state = driving.state
    var leftS = span.toSeconds
    while leftS > 0 do
      state = driven.step(state, north, east, leftS.min(driven.stepS))
      leftS -= driven.stepS
    driving.copy(state = state)

  def corrected(driving: Driving, seen: Kinematics, sinceSeen: Span): Driving =
    val heading    = seen.orientation.yawRad
    val (cos, sin) = (StrictMath.cos(heading), StrictMath.sin(heading))
    val state      = driving.state.copy(
      northM = seen.positionNed.x,
      eastM = seen.positionNed.y,
      headingRad = heading,
      frontMps = seen.velocityNed.x * cos + seen.velocityNed.y * sin,
      rightMps = seen.velocityNed.y * cos - seen.velocityNed.x * sin,
      yawRadPerS = seen.angularVelocityFrd.z
    )
    Driving(state, seen)

  def kinematics(driving: Driving): Kinematics =
    val at = driving.state
    driving.seen.copy(
      positionNed = Vector3(at.northM, at.eastM, driving.seen.positionNed.z),
      velocityNed = Vector3(at.northMps, at.eastMps, driving.seen.velocityNed.z),
      orientation = Quaternion.ofYaw(at.headingRad),
      angularVelocityFrd = Vector3(0, 0, at.yawRadPerS)
    )

object CarModel:

  /** The car's state, with the last reading.
    *
    * @param seen provides those components that the model does not change
    */
  final case class Driving private[vehicle] (state: CarState, seen: Kinematics)
