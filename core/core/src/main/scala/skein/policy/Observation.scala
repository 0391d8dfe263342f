package skein.policy

import skein.signal.Kinematics
import skein.units.*

/** The input of a policy's decision.
  *
  * @param self index of the own vehicle in the scenario
  * @param vehicles the estimate of each, the own included, by index
  * @param opponent index of the opponent: of several, the nearest at this moment; the own index where there
  *   is none
  * @param headings commanded last to each vehicle, as far as known, by index; before the first command, that
  *   of the start
  * @param elapsed since the own last decision; zero at the first
  * @param decisions made for this vehicle before
  * @param cruise the speed that the scenario gives the vehicle
  * @param startDown of the vehicle's start, down, negative above the origin
  * @param sensed last readings of the own vehicle's sensors, by name: those that the policy requests
  *   ([[Policy.sensors]]) and that have been received
  * @param actsIn predicted time until the command acts; zero where nothing is predicted
  */
final case class Observation(
    self: Int,
    vehicles: Vector[Seen],
    opponent: Int,
    headings: Vector[Radians],
    elapsed: Span,
    decisions: Long,
    cruise: MetresPerSecond,
    startDown: Metres,
    sensed: Map[String, Sensed] = Map.empty,
    actsIn: Span = Span.Zero
):
  def own: Seen = vehicles(self)

  /** The number of vehicles, the own one included. */
  def count: Int = vehicles.size

  /** A vehicle's position, m; likewise `eastM` and `downM`. */
  def northM(vehicle: Int): Double = vehicles(vehicle).kinematics.positionNed.x
  def eastM(vehicle: Int): Double  = vehicles(vehicle).kinematics.positionNed.y
  def downM(vehicle: Int): Double  = vehicles(vehicle).kinematics.positionNed.z

  def northMps(vehicle: Int): Double = vehicles(vehicle).kinematics.velocityNed.x
  def eastMps(vehicle: Int): Double  = vehicles(vehicle).kinematics.velocityNed.y

  def headingRad: Double = headings(self).value

  /** The action that follows a heading at the altitude of the own start. */
  def along(headingRad: Double, speedMps: Double): Action =
    Action.Along(Radians(headingRad), MetresPerSecond(speedMps), startDown)

  /** The action with this velocity, limited to a greatest speed, at the altitude of the own start. A velocity
    * without a direction keeps the heading.
    */
  def towards(northMps: Double, eastMps: Double, mostMps: Double): Action =
    val speed = StrictMath.hypot(northMps, eastMps)
    if speed < Action.LeastMps then along(headingRad, 0)
    else along(StrictMath.atan2(eastMps, northMps), speed.min(mostMps))

/** The estimate of one vehicle's state.
  *
  * @param kinematics world NED, in three dimensions with attitude
  * @param age of the reading behind it, since physics was sampled, by the estimated clock offset; before
  *   there is an offset, since the answer was received
  * @param isPredicted whether it is predicted for the moment at which the command will act, and not a plain
  *   reading
  */
final case class Seen(kinematics: Kinematics, age: Span, isPredicted: Boolean)

/** The last reading of a sensor.
  *
  * @param columns names with units, such as `altitudeM`
  * @param values one per column
  * @param age since it was measured, as [[Seen.age]]
  */
final case class Sensed(columns: Vector[String], values: Vector[Double], age: Span):

  /** The value of a column.
    *
    * @throws NoSuchElementException if there is no such column
    */
  def apply(column: String): Double =
    columns.indexOf(column) match
      case -1 =>
        throw java.util.NoSuchElementException(s"expected one of ${columns.mkString(", ")}, came '$column'")
      case index => values(index)
