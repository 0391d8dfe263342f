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
  * @param sensed
  *   what the sensors of the own vehicle said last, by name: those that the policy asked for ([[AgentPolicy.sensors]])
  *   and that have answered before
  * @param actsIn
  *   how long until the command acts, by the forecast; zero where nothing is predicted
  */
final case class Observation(
    self: Int,
    vehicles: Vector[Seen],
    opponent: Int,
    headings: Vector[Radians],
    elapsed: Span,
    decisions: Long,
    cruise: MetresPerSecond,
    altitude: Metres,
    sensed: Map[String, Sensed] = Map.empty,
    actsIn: Span = Span.Zero
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

/** What a sensor said last.
  *
  * @param columns
  *   names with units, such as `altitudeM`
  * @param values
  *   as many
  * @param age
  *   since it was measured, as [[Seen.age]]
  */
final case class Sensed(columns: Vector[String], values: Vector[Double], age: Span):

  /** A column's value.
    *
    * @throws NoSuchElementException
    *   if there is no such column
    */
  def apply(column: String): Double =
    columns.indexOf(column) match
      case -1 =>
        throw java.util.NoSuchElementException(s"expected one of ${columns.mkString(", ")}, came '$column'")
      case index => values(index)
