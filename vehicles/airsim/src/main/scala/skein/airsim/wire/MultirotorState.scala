package skein.airsim.wire

import skein.units.Instant

/** The part of `getMultirotorState`'s answer that our client reads; further keys, which differ between AirSim
  * and its forks, are skipped. `skein_missing`: see [[MultirotorState]].
  */
final private[skein] case class MultirotorReading(
    kinematics_estimated: KinematicsState,
    timestamp: Instant,
    landed_state: Int,
    skein_missing: Boolean = false
) derives Fields

/** The state as AirSim's server sends it. `landed_state` is 0 landed, 1 flying. `skein_missing` is absent
  * unless the built-in simulator's sensors have no reading: then this is an earlier one.
  */
final private[skein] case class MultirotorState(
    collision: CollisionInfo,
    kinematics_estimated: KinematicsState,
    gps_location: GeoPoint,
    timestamp: Instant,
    landed_state: Int,
    rc_data: RcData,
    skein_missing: Boolean = false
) derives Fields

/** `object_id` is −1 if nothing was touched. */
final private[skein] case class CollisionInfo(
    has_collided: Boolean,
    penetration_depth: Float,
    time_stamp: Instant,
    normal: Vector3r,
    impact_point: Vector3r,
    position: Vector3r,
    object_name: String,
    object_id: Int
) derives Fields

private[skein] object CollisionInfo:
  val None: CollisionInfo =
    CollisionInfo(false, 0, Instant.Epoch, Vector3r.Zero, Vector3r.Zero, Vector3r.Zero, "", -1)

/** A remote control's sticks, −1 to 1 (throttle 0 to 1). Clients send fewer keys, and others, than AirSim
  * sends back.
  */
final private[skein] case class RcData(
    timestamp: Instant = Instant.Epoch,
    pitch: Float = 0,
    roll: Float = 0,
    throttle: Float = 0,
    yaw: Float = 0,
    left_z: Float = 0,
    right_z: Float = 0,
    switches: Int = 0,
    vendor_id: String = "",
    is_initialized: Boolean = false,
    is_valid: Boolean = false
) derives Fields

private[skein] object RcData:
  val Absent: RcData = RcData()
