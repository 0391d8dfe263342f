package skein.airsim

import scala.concurrent.Future
import skein.rpc.RpcError
import skein.units.*

/** Moves that command attitude, rates or rotors instead of velocities or places. Angles are of the body FRD
  * against the world NED (roll to the right, pitch up, yaw towards east), rates about the body's axes in
  * rad/s, throttle and rotor controls from 0 to 1. Each flies for its duration.
  */
trait AttitudeMoves:

  /** Four numbers and how long. */
  protected def attitude(
      method: String,
      first: Double,
      second: Double,
      third: Double,
      fourth: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]]

  /** An altitude goal, world NED, in the vehicle's own frame. */
  protected def ownDown(down: Metres): Double

  /** Holds attitude and altitude. `down` is NED, in the world's frame, m. */
  def moveByRollPitchYawZ(
      roll: Radians,
      pitch: Radians,
      yaw: Radians,
      down: Metres,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByRollPitchYawZ", roll.value, pitch.value, yaw.value, ownDown(down), duration)

  /** Holds an attitude at a throttle from 0 to 1. */
  def moveByRollPitchYawThrottle(
      roll: Radians,
      pitch: Radians,
      yaw: Radians,
      throttle: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByRollPitchYawThrottle", roll.value, pitch.value, yaw.value, throttle, duration)

  /** Holds roll, pitch and altitude, and turns. `down` is NED, in the world's frame, m. */
  def moveByRollPitchYawRateZ(
      roll: Radians,
      pitch: Radians,
      yawRateRadPerS: Double,
      down: Metres,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByRollPitchYawrateZ", roll.value, pitch.value, yawRateRadPerS, ownDown(down), duration)

  /** Holds roll and pitch at a throttle from 0 to 1, and turns. */
  def moveByRollPitchYawRateThrottle(
      roll: Radians,
      pitch: Radians,
      yawRateRadPerS: Double,
      throttle: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByRollPitchYawrateThrottle", roll.value, pitch.value, yawRateRadPerS, throttle, duration)

  /** Turns about the body's axes and holds an altitude. `down` is NED, in the world's frame, m. */
  def moveByAngleRatesZ(
      rollRateRadPerS: Double,
      pitchRateRadPerS: Double,
      yawRateRadPerS: Double,
      down: Metres,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByAngleRatesZ", rollRateRadPerS, pitchRateRadPerS, yawRateRadPerS, ownDown(down), duration)

  /** Turns about the body's axes at a throttle from 0 to 1. */
  def moveByAngleRatesThrottle(
      rollRateRadPerS: Double,
      pitchRateRadPerS: Double,
      yawRateRadPerS: Double,
      throttle: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude(
      "moveByAngleRatesThrottle",
      rollRateRadPerS,
      pitchRateRadPerS,
      yawRateRadPerS,
      throttle,
      duration
    )

  /** Controls of the rotors themselves; no controller keeps the vehicle upright. */
  def moveByMotorPwms(
      frontRight: Double,
      rearLeft: Double,
      frontLeft: Double,
      rearRight: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByMotorPWMs", frontRight, rearLeft, frontLeft, rearRight, duration)
