package skein.hil

import skein.units.*
import skein.vehicle.{Airframe, Atmosphere}

/** Rotor controls of a quadrotor that holds a position: a cascade of position, velocity, tilt and rate, each
  * proportional to the error of the previous one; altitude and position with an integral.
  */
final class SmallController(airframe: Airframe = Airframe()):
  private var integral = Vector3.Zero

  /** Rotor controls: front right, rear left, front left, rear right. */
  def rotors(
      goalNed: Vector3,
      positionNed: Vector3,
      velocityNed: Vector3,
      orientation: Quaternion,
      angularVelocityFrd: Vector3,
      dtS: Double
  ): Vector[Double] =
    val off    = bounded((goalNed - positionNed) * 0.8, 1.5)
    val missed = off - velocityNed
    integral = bounded(integral + missed * (0.4 * dtS), 1)
    val wanted = bounded(missed * 2 + integral, 3)
    val up     = Airframe.Gravity - wanted.z
    val yaw    = orientation.yawRad
    val front  = wanted.x * StrictMath.cos(yaw) + wanted.y * StrictMath.sin(yaw)
    val right  = wanted.y * StrictMath.cos(yaw) - wanted.x * StrictMath.sin(yaw)
    val roll   = StrictMath.atan2(right, up)
    val pitch  = -StrictMath.atan2(front, up)
    val least  = 0.5 * Airframe.Gravity
    val thrust = airframe.massKg * up.max(least) /
      (4 * airframe.maxThrustN * Atmosphere.densityRatio(122)) /
      (StrictMath.cos(orientation.rollRad) * StrictMath.cos(orientation.pitchRad)).max(0.5)
    def torque(angle: Double, rate: Double, angleGain: Double, rateGain: Double) =
      ((angle * angleGain).max(-3).min(3) - rate) * rateGain
    val rollTorque  = torque(roll - orientation.rollRad, angularVelocityFrd.x, 6, 0.06)
    val pitchTorque = torque(pitch - orientation.pitchRad, angularVelocityFrd.y, 6, 0.06)
    val yawTorque   = torque(-yaw, angularVelocityFrd.z, 1, 0.3).max(-0.15).min(0.15)
    Vector(
      thrust - rollTorque + pitchTorque + yawTorque,
      thrust + rollTorque - pitchTorque + yawTorque,
      thrust + rollTorque + pitchTorque - yawTorque,
      thrust - rollTorque - pitchTorque - yawTorque
    ).map(_.max(0).min(1))

  private def bounded(v: Vector3, most: Double) =
    Vector3(v.x.max(-most).min(most), v.y.max(-most).min(most), v.z.max(-most).min(most))
