package skein.forecast

import skein.signal.{ClockAlignment, Kinematics, OneWayDelays, Stamped}
import skein.units.*
import skein.vehicle.VehicleModel

/** Estimates the states of vehicles at any moment, from their readings and from the commands sent to them.
  * Immutable and pure: it accepts events in any order.
  *
  * @param models one per vehicle: a model of the vehicle if its commands are known, else
  *   [[skein.vehicle.ConstantVelocity]] or [[skein.vehicle.ConstantTurn]]
  * @param delays mean one-way delays; None before the first reading
  */
final case class Forecast private (
    models: Vector[VehicleModel[?]],
    tracks: Vector[Option[VehicleForecast[?]]],
    alignment: Option[ClockAlignment],
    delays: Option[OneWayDelays]
):
  // The vehicles of a team request equal forecasts for equal moments, so the last result is cached.
  @volatile private var told: Option[(Instant, Vector[Estimate])] = None

  def withEvent(event: ForecastEvent): Forecast = event match
    case ForecastEvent.Seen(vehicle, reading)                  => seen(vehicle, reading)
    case ForecastEvent.Sent(vehicle, command)                  => updated(vehicle)(_.sent(command))
    case ForecastEvent.Planned(vehicle, commands)              => updated(vehicle)(_.planned(commands))
    case ForecastEvent.Replaced(vehicle, sequence, answeredAt) =>
      updated(vehicle)(_.replaced(sequence, answeredAt))
    case ForecastEvent.Failed(vehicle, sequence) => updated(vehicle)(_.failed(sequence))

  /** The states of the vehicles when a command that is sent now takes effect, given the commands under way.
    * None until every vehicle was read. If a vehicle's newest reading is later than that, its estimate is the
    * reading.
    *
    * @param now the current time, on the controller's clock
    */
  def whenActing(now: Instant): Option[Vector[Estimate]] =
    told
      .collect { case (`now`, estimates) => estimates }
      .orElse:
        for delays <- delays if tracks.forall(_.isDefined)
        yield
          val estimates = tracks.flatten.map(_.estimateAt(delays.expectedArrival(now), delays, now))
          told = Some((now, estimates))
          estimates

  /** The legs of each vehicle's flight from its newest reading until a command that is sent now takes effect,
    * which lead to the states of [[whenActing]]. None until every vehicle was read.
    */
  def legsWhenActing(now: Instant): Option[Vector[Vector[Leg]]] =
    for delays <- delays if tracks.forall(_.isDefined)
    yield tracks.flatten.map(_.legsTo(delays.expectedArrival(now), delays, now))

  /** The vehicles at the times of these estimates, from which further commands can be simulated.
    *
    * @param estimates the result of [[whenActing]], by vehicle
    * @param now the time passed to [[whenActing]]
    */
  def courses(estimates: Vector[Estimate], now: Instant): Vector[Course[?]] =
    tracks.zip(estimates).flatMap: (track, estimate) =>
      for track <- track; delays <- delays yield track.courseAt(estimate.predictedFor, delays, now)

  /** This forecast with one vehicle's prediction from another forecast. Both must have received equal
    * readings.
    */
  def withVehicleOf(other: Forecast, vehicle: Int): Forecast = copy(
    models = models.updated(vehicle, other.models(vehicle)),
    tracks = tracks.updated(vehicle, other.tracks(vehicle))
  )

  private def seen(vehicle: Int, reading: Stamped[Kinematics]): Forecast =
    // Readings from before a restart of the simulator are useless for predictions.
    if alignment.exists(_.isOfFormerRun(reading)) then this else seenOfPresent(vehicle, reading)

  private def seenOfPresent(vehicle: Int, reading: Stamped[Kinematics]): Forecast =
    val aligned = alignment.fold(ClockAlignment.of(reading))(_.updated(reading))
    // While the simulator's clock stood still, delays measured against it were meaningless.
    val goesOn  = alignment.exists(before => before.restarts == aligned.restarts && !before.standsStill)
    val current = delays.filter(_ => goesOn).fold(OneWayDelays.of(reading))(_.updated(reading))
    val track   = tracks(vehicle).fold(firstSeen(vehicle, reading)): track =>
      if reading.validAt < track.newest.validAt && aligned.isNewer(reading, track.newest) then
        track.startedAgain(reading)
      else track.seen(reading, current)
    copy(
      tracks = tracks.updated(vehicle, Some(track)),
      alignment = Some(aligned),
      delays = Some(current)
    )

  private def firstSeen(vehicle: Int, reading: Stamped[Kinematics]): VehicleForecast[?] =
    models(vehicle) match
      case model: VehicleModel[s] => VehicleForecast(model, reading)

  private def updated(vehicle: Int)(change: VehicleForecast[?] => VehicleForecast[?]): Forecast =
    copy(tracks = tracks.updated(vehicle, tracks(vehicle).map(change)))

object Forecast:
  def apply(models: Vector[VehicleModel[?]]): Forecast =
    new Forecast(models, models.map(_ => None), None, None)

/** An event that changes a forecast. Vehicles are counted from 0. */
enum ForecastEvent:
  def vehicle: Int

  case Seen(vehicle: Int, reading: Stamped[Kinematics])

  case Sent(vehicle: Int, command: Commanded)

  /** A plan was sent to the buffer on the vehicle's side of the link.
    *
    * @param commands its actions, each with the time at which it acts
    */
  case Planned(vehicle: Int, commands: Vector[Commanded])

  /** The vehicle reported that a command was replaced, which acknowledges its successor; AirSim does so when
    * the successor arrives.
    */
  case Replaced(vehicle: Int, sequence: Long, answeredAt: Instant)

  case Failed(vehicle: Int, sequence: Long)
