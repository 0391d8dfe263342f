package skein.forward

import skein.signal.Kinematics
import skein.units.{Quaternion, Vector3}
import skein.vehicle.QuadrotorState

/** A vehicle whose state is known at the ends of whole steps. Between steps it is extrapolated with constant
  * acceleration, as in the built-in simulator. Readings are rounded to 32-bit floats relative to the start,
  * as on AirSim's wire. Mutable.
  */
private[skein] abstract class SteppedVehicle extends Vehicle:
  protected var originX, originY = 0.0

  protected def sinceStepS: Double

  /** At least the motion at the end of the last step, relative to the start. */
  protected val state: QuadrotorState = QuadrotorState()

  final def x: Double  = originX + moved(state.x, state.vx, state.ax)
  final def y: Double  = originY + moved(state.y, state.vy, state.ay)
  final def z: Double  = moved(state.z, state.vz, state.az)
  final def vx: Double = state.vx + state.ax * sinceStepS
  final def vy: Double = state.vy + state.ay * sinceStepS

  final override def seenX: Double  = moved(state.x, state.vx, state.ax).toFloat + originX
  final override def seenY: Double  = moved(state.y, state.vy, state.ay).toFloat + originY
  final override def seenZ: Double  = z.toFloat
  final override def seenVx: Double = vx.toFloat
  final override def seenVy: Double = vy.toFloat

  final override def seen: Kinematics = Kinematics(
    Vector3(seenX, seenY, seenZ),
    Vector3(seenVx, seenVy, (state.vz + state.az * sinceStepS).toFloat),
    Quaternion(state.qw.toFloat, state.qx.toFloat, state.qy.toFloat, state.qz.toFloat),
    Vector3(state.wx.toFloat, state.wy.toFloat, state.wz.toFloat)
  )

  private def moved(from: Double, speed: Double, acceleration: Double): Double =
    val t = sinceStepS
    from + speed * t + acceleration * (t * t / 2)
