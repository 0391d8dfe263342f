package skein.loop

import skein.policy.{Action, Fleet, Seen}
import skein.forecast.{Estimate, ForecastEvent, Forecast}
import skein.signal.{ClockAlignment, Kinematics, Stamped}
import skein.units.*

/** A command that was sent to a vehicle, as other vehicles' policies observe it.
  *
  * @param heading the heading to which the action leads; for an action without one, that of the command
  *   before
  */
final case class SentCommand(
    vehicle: Int,
    decision: Long,
    heading: Radians,
    sentAt: Instant,
    action: Action
)

/** The controller's knowledge of the team: the newest reading and the last move of each vehicle, by index,
  * and the relation of the two clocks.
  *
  * @param sensed the newest reading of each sensor in use, indexed by vehicle
  * @param forecast present if the loop predicts
  * @param estimates the estimate of every vehicle for the time at which a command decided on this view takes
  *   effect; absent if none are made
  * @param knows what policies may see of the other vehicles
  * @param strangers predicts each vehicle from its readings only; present if the loop predicts and commands
  *   of others are not known
  * @param byMessages the vehicles that are known by messages: how long these took says nothing of the clocks,
  *   nor of when a command acts
  */
final case class TeamView(
    readings: Vector[Option[Reading]],
    moves: Vector[Option[SentCommand]],
    alignment: Option[ClockAlignment],
    sensed: Vector[Map[String, SensorReading]],
    forecast: Option[Forecast] = None,
    estimates: Option[Vector[Estimate]] = None,
    knows: Knowledge = Knowledge.All,
    strangers: Option[Forecast] = None,
    byMessages: Set[Int] = Set.empty
):
  def withReading(reading: Reading): TeamView =
    copy(
      readings = readings.updated(reading.vehicle, Some(reading)),
      alignment = aligned(reading)
    ).withEvent(ForecastEvent.Seen(reading.vehicle, reading.state))

  /** The view with this reading, unless it holds a newer one. */
  def withSensorReading(reading: SensorReading): TeamView =
    val held   = sensed(reading.vehicle)
    val clocks = alignment.getOrElse(ClockAlignment.of(reading.values))
    if held.get(reading.sensor).exists(known => !clocks.isNewer(reading.values, known.values)) then this
    else copy(sensed = sensed.updated(reading.vehicle, held.updated(reading.sensor, reading)))

  def withMove(move: SentCommand): TeamView = copy(moves = moves.updated(move.vehicle, Some(move)))

  def withEvent(event: ForecastEvent): TeamView = copy(
    forecast = if byMessages(event.vehicle) then forecast else forecast.map(_.withEvent(event)),
    strangers = event match
      case _: ForecastEvent.Seen => strangers.map(_.withEvent(event))
      case _                     => strangers
  )

  /** The view with the forecast of one vehicle's controller. */
  def of(vehicle: Int): TeamView = strangers.fold(this): others =>
    val strange = readings.indices.filter(_ != vehicle)
    copy(forecast = forecast.map(strange.foldLeft(_)(_.withVehicleOf(others, _))))

  /** Age of a reading by the two clocks; before they are related, since its arrival. */
  def ageOf(reading: Stamped[?], now: Instant): Span =
    alignment.flatMap(_.ageOf(reading, now)).getOrElse(reading.ageByArrival(now))

  /** The newest readings, not predicted, in the order of vehicles; a vehicle that was not read is missing. */
  def asRead(now: Instant): Vector[Seen] = readings.flatten.map: reading =>
    Seen(reading.state.value, ageOf(reading.state, now), isPredicted = false)

  /** A vehicle's state: the estimate, or else the reading. */
  def kinematics(vehicle: Int): Kinematics =
    estimates.fold(readings(vehicle).get.state.value)(_(vehicle).kinematics)

  /** The last heading commanded to a vehicle, as far as known; before the first command that of the start. */
  def headingRad(vehicle: Int, fleet: Fleet): Double =
    moves(vehicle).fold(fleet.agents(vehicle).startHeading.value)(_.heading.value)

  /** The heading of another vehicle as policies see it, rad: the last commanded, or, if commands of others
    * are not known, its direction of motion; at rest, the heading at the start.
    */
  def seenHeadingRad(vehicle: Int, fleet: Fleet): Double = knows match
    case Knowledge.All       => headingRad(vehicle, fleet)
    case Knowledge.Positions =>
      val velocity = kinematics(vehicle).velocityNed
      if StrictMath.hypot(velocity.x, velocity.y) < TeamView.StillMps then
        fleet.agents(vehicle).startHeading.value
      else StrictMath.atan2(velocity.y, velocity.x)

  /** Whether a reading is newer than the one held: a late answer never overrides a newer one. */
  def isNews(reading: Reading): Boolean =
    val clocks = aligned(reading).getOrElse(ClockAlignment.of(reading.state))
    readings(reading.vehicle).forall(held => clocks.isNewer(reading.state, held.state))

  private def aligned(reading: Reading): Option[ClockAlignment] =
    // A message's delays also contain the way between the vehicles.
    if byMessages(reading.vehicle) then alignment
    else Some(alignment.fold(ClockAlignment.of(reading.state))(_.updated(reading.state)))

  /** Whether every vehicle was read at least once; before that there are no decisions. */
  def isComplete: Boolean = readings.forall(_.isDefined)

object TeamView:
  /** A vehicle slower than this stands still: it has no direction. */
  private val StillMps = 0.1

  def empty(vehicles: Int): TeamView =
    TeamView(Vector.fill(vehicles)(None), Vector.fill(vehicles)(None), None, Vector.fill(vehicles)(Map.empty))
