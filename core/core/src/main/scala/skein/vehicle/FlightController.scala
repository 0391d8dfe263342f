package skein.vehicle

import scala.annotation.unused

/** Gains and limits of AirSim's default flight controller, SimpleFlight (its `Params.hpp`, 1.8). Gains that
  * are zero there have no field here: all derivatives, and all integrals except that of the vertical
  * velocity.
  *
  * @param rateP gain: torque command per rad/s
  * @param maxRate maximum rate of roll, pitch and yaw, rad/s
  * @param angleP gain: share of `maxRate` per rad
  * @param maxTilt maximum roll and pitch, rad
  * @param velocityP gain: share of `maxTilt` per m/s
  * @param verticalP gain: command per m/s; a command is from −1 for full throttle to +1 for none
  * @param verticalI gain of the integral, per m/s and second
  * @param verticalDiscount factor on the integral term at every update
  * @param minThrottle minimum throttle of a velocity controller, so that a falling vehicle can still tilt
  * @param positionP gain: share of `maxVelocity` per m
  * @param maxVelocity maximum velocity that a position error commands, m/s
  * @param minAnglingThrottle throttle below which all rotors receive only the throttle, without roll, pitch
  *   and yaw
  */
final case class ControllerGains(
    rateP: Double = 0.25,
    maxRate: Double = 2.5,
    angleP: Double = 2.5,
    maxTilt: Double = math.Pi / 5.5,
    velocityP: Double = 0.2,
    verticalP: Double = 2.0,
    verticalI: Double = 2.0,
    verticalDiscount: Double = 0.9999,
    minThrottle: Double = 0.3,
    positionP: Double = 0.25,
    maxVelocity: Double = 6.0,
    minAnglingThrottle: Double = 0.05
)

/** AirSim's default flight controller: a cascade per axis, position → velocity → angle → rate → torque
  * command, and the mixer that turns the four commands into rotor controls. It receives the true state.
  *
  * '''The quirk that shapes every flight.''' In velocity mode roll and pitch rotate the ''whole'' goal triple
  * into the body frame, whatever its third component means. Under [[Setpoint.velocityZ]] that is an altitude,
  * so a vehicle tilted by α treats sin α · z as a wanted speed and tilts less. The higher it flies, the
  * slower it responds.
  *
  * [[TunedFlightController]] is this cascade with separate gains for every controller.
  *
  * @param stepS time between updates, s
  */
open class FlightController(val gains: ControllerGains, stepS: Double):
  import gains.*
  import CascadeLoop.*

  /** Sets the rotor controls in `state` for its next step. */
  def update(state: QuadrotorState, setpoint: Setpoint): Unit =
    if setpoint.horizontal eq HorizontalMode.Rotors then passThrough(state, setpoint)
    else control(state, setpoint)

  private def passThrough(state: QuadrotorState, setpoint: Setpoint): Unit =
    state.verticalMode = setpoint.vertical
    state.control0 = clip(setpoint.first)
    state.control1 = clip(setpoint.second)
    state.control2 = clip(setpoint.third)
    state.control3 = clip(setpoint.yawGoal)

  private inline def clip(control: Double): Double = math.max(0.0, math.min(control, 1.0))

  private def control(state: QuadrotorState, setpoint: Setpoint): Unit =
    import state.{qw, qx, qy, qz}

    // Rows of the rotation from body to world; their transpose rotates from world to body.
    val r00 = 1 - 2 * (qy * qy + qz * qz)
    val r10 = 2 * (qx * qy + qw * qz)
    val r20 = 2 * (qx * qz - qw * qy)
    val r01 = 2 * (qx * qy - qw * qz)
    val r11 = 1 - 2 * (qx * qx + qz * qz)
    val r21 = 2 * (qy * qz + qw * qx)
    val r02 = 2 * (qx * qz + qw * qy)
    val r12 = 2 * (qy * qz - qw * qx)
    val r22 = 1 - 2 * (qx * qx + qy * qy)

    var rollRate  = setpoint.first
    var pitchRate = setpoint.second
    if setpoint.horizontal ne HorizontalMode.Rates then
      var roll  = setpoint.first
      var pitch = setpoint.second
      if setpoint.horizontal ne HorizontalMode.Angles then
        var frontGoal = 0.0
        var rightGoal = 0.0
        if setpoint.horizontal eq HorizontalMode.Velocity then
          frontGoal = r00 * setpoint.first + r10 * setpoint.second + r20 * setpoint.third
          rightGoal = r01 * setpoint.first + r11 * setpoint.second + r21 * setpoint.third
        else
          frontGoal = r00 * velocityTowards(state, NorthPosition, setpoint.first - state.x)
          rightGoal = r11 * velocityTowards(state, EastPosition, setpoint.second - state.y)
        val front = r00 * state.vx + r10 * state.vy + r20 * state.vz
        val right = r01 * state.vx + r11 * state.vy + r21 * state.vz
        roll = respond(state, RightVelocity, velocityP, rightGoal - right) * maxTilt
        pitch = -respond(state, FrontVelocity, velocityP, frontGoal - front) * maxTilt
      rollRate = rateTowards(state, RollAngle, clamp(roll, maxTilt) - StrictMath.atan2(r21, r22))
      pitchRate = rateTowards(state, PitchAngle, clamp(pitch, maxTilt) + StrictMath.asin(unit(r20)))
    val yawRate =
      if setpoint.yaw eq YawMode.Rate then setpoint.yawGoal
      else rateTowards(state, YawAngle, setpoint.yawGoal - StrictMath.atan2(r10, r00))

    val rollCommand  = torque(state, RollRate, rollRate, state.wx)
    val pitchCommand = torque(state, PitchRate, pitchRate, state.wy)
    val yawCommand   = torque(state, YawRate, yawRate, state.wz)
    val throttle     =
      if setpoint.vertical eq VerticalMode.Throttle then setpoint.third
      else
        val downGoal =
          if setpoint.vertical eq VerticalMode.Position then
            r22 * velocityTowards(state, DownPosition, setpoint.third - state.z)
          else if setpoint.horizontal eq HorizontalMode.Velocity then
            r02 * setpoint.first + r12 * setpoint.second + r22 * setpoint.third
          else r22 * setpoint.third
        verticalThrottle(state, setpoint, downGoal - (r02 * state.vx + r12 * state.vy + r22 * state.vz))
    state.verticalMode = setpoint.vertical
    mix(state, rollCommand, pitchCommand, yawCommand, throttle)

  /** The integral term of a vehicle that hovers at this throttle, and its constant velocity error, m/s. In
    * every update, the discount of the integral equals the contribution of that error.
    */
  private[vehicle] def hoverIntegral(throttle: Double): (Double, Double) =
    val out              = 1 - 2 * throttle
    val integralPerError = stepS * verticalI / (1 - verticalDiscount)
    val error            = out / (verticalP + integralPerError)
    (error * integralPerError, error)

  private def verticalThrottle(state: QuadrotorState, setpoint: Setpoint, error: Double): Double =
    math.max((1 - climb(state, setpoint, error)) / 2, minThrottle)

  /** Output of the vertical velocity's controller for a velocity error, −1 to 1. */
  protected def climb(state: QuadrotorState, setpoint: Setpoint, error: Double): Double =
    // A new controller does not integrate, because its clock has not advanced yet.
    if state.verticalMode eq setpoint.vertical then
      state.verticalIntegral = unit(state.verticalIntegral * verticalDiscount + stepS * error * verticalI)
    else state.verticalIntegral = 0.0
    unit(verticalP * error + state.verticalIntegral)

  /** Output of one controller of the cascade for its error, −1 to 1.
    *
    * @param loop index of the controller, see [[CascadeMemory]]
    * @param gain proportional gain of the controller according to `gains`
    */
  protected def respond(
      @unused state: QuadrotorState,
      @unused loop: Int,
      gain: Double,
      error: Double
  ): Double =
    unit(gain * error)

  private def velocityTowards(state: QuadrotorState, loop: Int, error: Double): Double =
    respond(state, loop, positionP, error) * maxVelocity

  private def rateTowards(state: QuadrotorState, loop: Int, error: Double): Double =
    respond(state, loop, angleP, shorterWay(error)) * maxRate

  private def torque(state: QuadrotorState, loop: Int, rateGoal: Double, rate: Double): Double =
    respond(state, loop, rateP, clamp(rateGoal, maxRate) - rate)

  private def mix(
      state: QuadrotorState,
      roll: Double,
      pitch: Double,
      yaw: Double,
      throttle: Double
  ): Unit =
    if throttle < minAnglingThrottle then
      val each = throttle.max(0.0)
      state.control0 = each; state.control1 = each; state.control2 = each; state.control3 = each
    else
      val c0    = throttle - roll + pitch + yaw
      val c1    = throttle + roll - pitch + yaw
      val c2    = throttle + roll + pitch - yaw
      val c3    = throttle - roll - pitch - yaw
      val raise = math.max(0.0, -math.min(math.min(c0, c1), math.min(c2, c3)))
      val scale = 1 / math.max(1.0, math.max(math.max(c0, c1), math.max(c2, c3)) + raise)
      state.control0 = (c0 + raise) * scale
      state.control1 = (c1 + raise) * scale
      state.control2 = (c2 + raise) * scale
      state.control3 = (c3 + raise) * scale

  protected inline def unit(value: Double): Double = math.max(-1.0, math.min(value, 1.0))

  private inline def clamp(value: Double, limit: Double): Double = math.max(-limit, math.min(value, limit))

  private inline def shorterWay(angle: Double): Double =
    if math.abs(angle) <= math.Pi then angle else math.IEEEremainder(angle, 2 * math.Pi)
