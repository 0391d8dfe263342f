package skein.airsim.wire

/** Position (m, from the vehicle's own start), velocity and linear acceleration in NED; angular velocity and
  * acceleration in body FRD. It carries no time stamp.
  */
final private[skein] case class KinematicsState(
    position: Vector3r,
    orientation: Quaternionr,
    linear_velocity: Vector3r,
    angular_velocity: Vector3r,
    linear_acceleration: Vector3r,
    angular_acceleration: Vector3r
) derives Fields
