package skein.airsim

import scala.concurrent.Future
import skein.rpc.RpcError
import skein.units.*

/** Moves that command attitude, rates or rotors instead of velocities or positions. Angles are of the body
  * FRD against the world NED (roll to the right, pitch up, yaw towards east), rates are about the body's axes
  * in rad/s, throttle and rotor controls are from 0 to 1. Each move lasts for its duration.
  */
trait AttitudeMoves:

  /** Sends a move of four values that lasts for `duration`. */
  protected def attitude(method: String, duration: Span, numbers: Double*): Future[Either[RpcError, Boolean]]

  /** Converts an altitude goal from world NED to the vehicle's own frame. */
  protected def ownDown(down: Metres): Double

  /** Holds attitude and altitude. `down` is NED, in the world's frame, m. */
  def moveByRollPitchYawZ(
      roll: Radians,
      pitch: Radians,
      yaw: Radians,
      down: Metres,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByRollPitchYawZ", duration, roll.value, pitch.value, yaw.value, ownDown(down))

  /** Holds an attitude at a throttle from 0 to 1. */
  def moveByRollPitchYawThrottle(
      roll: Radians,
      pitch: Radians,
      yaw: Radians,
      throttle: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByRollPitchYawThrottle", duration, roll.value, pitch.value, yaw.value, throttle)

  /** Holds roll, pitch and altitude, and turns. `down` is NED, in the world's frame, m. */
  def moveByRollPitchYawRateZ(
      roll: Radians,
      pitch: Radians,
      yawRateRadPerS: Double,
      down: Metres,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByRollPitchYawrateZ", duration, roll.value, pitch.value, yawRateRadPerS, ownDown(down))

  /** Holds roll and pitch at a throttle from 0 to 1, and turns. */
  def moveByRollPitchYawRateThrottle(
      roll: Radians,
      pitch: Radians,
      yawRateRadPerS: Double,
      throttle: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByRollPitchYawrateThrottle", duration, roll.value, pitch.value, yawRateRadPerS, throttle)

  /** Turns about the body's axes and holds an altitude. `down` is NED, in the world's frame, m. */
  def moveByAngleRatesZ(
      rollRateRadPerS: Double,
      pitchRateRadPerS: Double,
      yawRateRadPerS: Double,
      down: Metres,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByAngleRatesZ", duration, rollRateRadPerS, pitchRateRadPerS, yawRateRadPerS, ownDown(down))

  /** Turns about the body's axes at a throttle from 0 to 1. */
  def moveByAngleRatesThrottle(
      rollRateRadPerS: Double,
      pitchRateRadPerS: Double,
      yawRateRadPerS: Double,
      throttle: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    val rates = Seq(rollRateRadPerS, pitchRateRadPerS, yawRateRadPerS)
    attitude("moveByAngleRatesThrottle", duration, rates :+ throttle*)

  /** Controls the rotors directly; no controller keeps the vehicle upright. */
  def moveByMotorPwms(
      frontRight: Double,
      rearLeft: Double,
      frontLeft: Double,
      rearRight: Double,
      duration: Span
  ): Future[Either[RpcError, Boolean]] =
    attitude("moveByMotorPWMs", duration, frontRight, rearLeft, frontLeft, rearRight)
