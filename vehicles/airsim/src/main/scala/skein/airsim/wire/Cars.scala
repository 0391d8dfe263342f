package skein.airsim.wire

import skein.units.Instant

/** A car's pedals, steering wheel and gear lever. Throttle and steering −1 to 1, brake 0 to 1; `manual_gear`
  * counts only with `is_manual_gear`, −1 is reverse.
  */
final private[skein] case class CarControls(
    throttle: Float = 0,
    steering: Float = 0,
    brake: Float = 0,
    handbrake: Boolean = false,
    is_manual_gear: Boolean = false,
    manual_gear: Int = 0,
    gear_immediate: Boolean = true
) derives Fields

/** The state of a camera rig that is no vehicle; only in Cosys-AirSim. */
final private[skein] case class ComputerVisionState(kinematics_estimated: KinematicsState, timestamp: Instant)
    derives Fields

/** A car's state: speed along the heading in m/s, negative in reverse; engine speed in turns a minute.
  * `skein_missing`: see [[MultirotorState]].
  */
final private[skein] case class CarState(
    speed: Float,
    gear: Int,
    rpm: Float,
    maxrpm: Float,
    handbrake: Boolean,
    kinematics_estimated: KinematicsState,
    timestamp: Instant,
    skein_missing: Boolean = false
) derives Fields
