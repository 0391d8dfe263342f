package skein.policy

import skein.signal.Kinematics
import skein.units.*

/** What a policy decides upon.
  *
  * @param self
  *   the own place among the vehicles of the scenario
  * @param vehicles
  *   what is known of each, the own included, by place
  * @param opponent
  *   whom the scenario sets the vehicle against at this moment: the nearest of those; the own place where there is none
  * @param headings
  *   commanded last to each vehicle, as far as known, by place; before the first command that of the start
  * @param elapsed
  *   since the own last decision; zero at the first
  * @param decisions
  *   made for this vehicle before
  * @param cruise
  *   the speed that the scenario gives the vehicle
  * @param altitude
  *   of the vehicle's start, down, negative above the origin
  */
final case class Observation(
    self: Int,
    vehicles: Vector[Seen],
    opponent: Int,
    headings: Vector[Radians],
    elapsed: Span,
    decisions: Long,
    cruise: MetresPerSecond,
    altitude: Metres
):
  def own: Seen = vehicles(self)

/** What is known of one vehicle.
  *
  * @param kinematics
  *   world NED, in three dimensions with attitude
  * @param age
  *   of the reading that this rests on, since physics was sampled, by the estimate of the clocks' offset; before there is
  *   one, since the answer came
  * @param isPredicted
  *   whether it was carried forward to when the command will act, and not just heard
  */
final case class Seen(kinematics: Kinematics, age: Span, isPredicted: Boolean)
