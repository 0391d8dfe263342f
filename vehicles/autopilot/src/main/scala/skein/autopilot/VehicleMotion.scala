package skein.autopilot

import skein.signal.Kinematics
import skein.units.Span

/** An autopilot's knowledge of its vehicle: in a simulator, its true motion.
  *
  * @param sinceBoot the autopilot's clock
  * @param state position and motion in the vehicle's own frame, whose origin is its start
  * @param isFlying whether it has taken off and not landed since
  */
final case class VehicleMotion(sinceBoot: Span, state: Kinematics, isFlying: Boolean)
