package skein.forward

import skein.signal.Kinematics
import skein.units.{Quaternion, Vector3}

/** A vehicle whose state is known at the ends of whole steps. Between steps it is extrapolated with constant
  * acceleration, as in the built-in simulator. Readings are rounded to 32-bit floats relative to the start,
  * as on AirSim's wire. Mutable.
  */
private[skein] abstract class SteppedVehicle extends Vehicle:
  protected var originX, originY = 0.0

  protected def sinceStepS: Double

  // The state at the end of the last step, relative to the start: m, m/s, m/s², rad/s.
  protected def stepX: Double
  protected def stepY: Double
  protected def stepZ: Double
  protected def stepVx: Double
  protected def stepVy: Double
  protected def stepVz: Double
  protected def stepAx: Double
  protected def stepAy: Double
  protected def stepAz: Double
  protected def orientation: Quaternion
  protected def angularVelocityFrd: Vector3

  final def x: Double  = originX + moved(stepX, stepVx, stepAx)
  final def y: Double  = originY + moved(stepY, stepVy, stepAy)
  final def z: Double  = moved(stepZ, stepVz, stepAz)
  final def vx: Double = stepVx + stepAx * sinceStepS
  final def vy: Double = stepVy + stepAy * sinceStepS

  final override def seenX: Double  = moved(stepX, stepVx, stepAx).toFloat + originX
  final override def seenY: Double  = moved(stepY, stepVy, stepAy).toFloat + originY
  final override def seenZ: Double  = z.toFloat
  final override def seenVx: Double = vx.toFloat
  final override def seenVy: Double = vy.toFloat

  final override def seen: Kinematics = Kinematics(
    Vector3(seenX, seenY, seenZ),
    Vector3(seenVx, seenVy, (stepVz + stepAz * sinceStepS).toFloat),
    orientation,
    angularVelocityFrd
  )

  private def moved(from: Double, speed: Double, acceleration: Double): Double =
    val t = sinceStepS
    from + speed * t + acceleration * (t * t / 2)
