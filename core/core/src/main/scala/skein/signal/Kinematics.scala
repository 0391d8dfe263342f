package skein.signal

import skein.units.*

/** The position and motion of a vehicle, in the world frame (NED, one origin for all vehicles).
  *
  * @param positionNed position, m
  * @param velocityNed velocity, m/s
  * @param orientation rotates from body FRD to world NED
  * @param angularVelocityFrd angular velocity, rad/s
  */
final case class Kinematics(
    positionNed: Vector3,
    velocityNed: Vector3,
    orientation: Quaternion,
    angularVelocityFrd: Vector3
):
  /** Whether every component is a finite number. */
  def isFinite: Boolean =
    def all(v: Vector3) = v.x.isFinite && v.y.isFinite && v.z.isFinite
    val turn            = Seq(orientation.w, orientation.x, orientation.y, orientation.z)
    all(positionNed) && all(velocityNed) && all(angularVelocityFrd) && turn.forall(_.isFinite)
