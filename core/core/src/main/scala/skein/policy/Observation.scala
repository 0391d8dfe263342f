package skein.policy

import skein.signal.Kinematics
import skein.units.*

/** The input of a policy's decision.
  *
  * @param self index of this vehicle in the scenario
  * @param vehicles estimates of all vehicles, by index
  * @param opponent index of the opponent; of several, the nearest at this moment; `self` if there is none
  * @param headings last commanded heading of each vehicle, as far as known, by index; before the first
  *   command, the heading at the start
  * @param elapsed time since this vehicle's previous decision; zero at the first
  * @param decisions number of earlier decisions for this vehicle
  * @param cruise the vehicle's speed according to the scenario
  * @param startDown altitude of the vehicle's start, down, negative above the origin
  * @param sensed last readings of this vehicle's sensors, keyed by name: those that the policy requests
  *   ([[Policy.sensors]]) and that have arrived
  * @param actsIn predicted time until the command takes effect; zero in loops without predictions
  * @param time time of the flight at which the command takes effect, as far as the loop knows: the present
  *   plus `actsIn`, since this vehicle was first read
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
    actsIn: Span = Span.Zero,
    time: Span = Span.Zero
):
  def own: Seen = vehicles(self)

  /** The number of vehicles, this one included. */
  def count: Int = vehicles.size

  /** A vehicle's position north, m; `eastM` and `downM` likewise. */
  def northM(vehicle: Int): Double = vehicles(vehicle).kinematics.positionNed.x
  def eastM(vehicle: Int): Double  = vehicles(vehicle).kinematics.positionNed.y
  def downM(vehicle: Int): Double  = vehicles(vehicle).kinematics.positionNed.z

  def northMps(vehicle: Int): Double = vehicles(vehicle).kinematics.velocityNed.x
  def eastMps(vehicle: Int): Double  = vehicles(vehicle).kinematics.velocityNed.y

  def headingRad: Double = headings(self).value

  /** Flight along a heading at the altitude of this vehicle's start. */
  def along(headingRad: Double, speedMps: Double): Action =
    Action.Along(Radians(headingRad), MetresPerSecond(speedMps), startDown)

  /** Flight with this velocity, limited to a maximum speed, at the altitude of this vehicle's start. A
    * velocity near zero keeps the heading.
    */
  def towards(northMps: Double, eastMps: Double, mostMps: Double): Action =
    val speed = StrictMath.hypot(northMps, eastMps)
    if speed < Action.LeastMps then along(headingRad, 0)
    else along(StrictMath.atan2(eastMps, northMps), speed.min(mostMps))

/** The estimate of one vehicle's state.
  *
  * @param kinematics world NED, in three dimensions with attitude
  * @param age age of the reading on which the estimate is based: since sampling, by the estimated clock
  *   offset, or since the answer's arrival as long as there is no such estimate
  * @param isPredicted whether the estimate is predicted for the time at which the command takes effect;
  *   otherwise it is a reading
  */
final case class Seen(kinematics: Kinematics, age: Span, isPredicted: Boolean)

/** The last reading of a sensor.
  *
  * @param columns names with units, such as `altitudeM`
  * @param values one value per column
  * @param age age of the reading, like [[Seen.age]]
  */
final case class Sensed(columns: Vector[String], values: Vector[Double], age: Span):

  /** The value of a column.
    *
    * @throws NoSuchElementException if there is no such column
    */
  def apply(column: String): Double =
    columns.indexOf(column) match
      case -1 =>
        throw java.util.NoSuchElementException(s"expected one of ${columns.mkString(", ")}, got '$column'")
      case index => values(index)
