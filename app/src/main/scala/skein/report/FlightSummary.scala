package skein.report

import skein.record.*
import skein.units.*

/** What one recording comes to.
  *
  * @param roles
  *   evaders first, as in the paper
  * @param roundTripsMs
  *   of the link's own samples where there are any, else of the readings
  * @param distance
  *   in a duel, between the first pursuer and the first evader; absent if they were not both seen
  * @param policy
  *   short name of the policy that was flown in the place of the paper's; the flight's scenario says more
  * @param team
  *   absent for a duel
  * @param planning
  *   absent where nothing was planned
  * @param predictions
  *   absent where nothing was predicted
  */
final case class FlightSummary(
    flight: Flight,
    tracks: Vector[Track],
    distance: Option[DistanceCurve],
    roles: Vector[RoleSummary],
    roundTripsMs: Option[Distribution],
    readings: Int,
    decisions: Int,
    commands: Int,
    events: Map[EventKind, Int],
    aborted: Option[String],
    team: Option[TeamResult] = None,
    policy: Option[String] = None,
    planning: Option[PlanningSummary] = None,
    predictions: Option[(own: PredictionErrors, others: PredictionErrors)] = None
):
  /** The loop, and the policy where it is not the paper's. */
  def name: String = flight.loop + policy.fold("")(policy => s", $policy")

  /** Time flown on the simulator's clock, s. */
  def flownS: Double =
    team.map(_.curve.last._1).orElse(distance.map(_.points.last._1)).getOrElse(0.0)

  /** What stands for the flight when it is compared with others, m: of a duel the mean distance over the last 10 s, of a
    * team its first measure.
    */
  def headlineM: Option[Double] = team match
    case Some(result) => result.measures.head.value
    case None         => distance.map(_.lastTenSeconds.mean)

  /** The paper's flight of this loop over this link; it published duels alone. */
  def published: Option[Published.Flight] =
    if team.isDefined || policy.isDefined then None else Published.flight(flight.loop, flight.link)

  def count(kind: EventKind): Int = events.getOrElse(kind, 0)

/** The decisions for all vehicles of one role.
  *
  * @param ownTrueAgeMs
  *   from when physics was sampled to the decision
  */
final case class RoleSummary(
    role: String,
    observedMs: Map[Observation, Distribution],
    ownTrueAgeMs: Option[Distribution],
    opponentTrueAgeMs: Option[Distribution]
)

object FlightSummary:

  def of(recording: Recording): FlightSummary =
    val tracks = Track.of(recording)
    val team   = TeamResult.of(recording, tracks)
    FlightSummary(
      recording.flight,
      tracks,
      for
        pursuer <- tracks.find(_.role == "pursuer") if team.isEmpty
        evader  <- tracks.find(_.role == "evader")
        curve   <- DistanceCurve.between(pursuer, evader)
      yield curve,
      roles(recording),
      roundTripsMs(recording),
      recording.readings.size,
      recording.decisions.size,
      recording.commands.size,
      recording.events.groupMapReduce(_.kind)(_ => 1)(_ + _),
      recording.events.find(_.kind == EventKind.Aborted).map(_.detail),
      team,
      recording.heading.parameters.find(_.name == "policy").map(_.value),
      PlanningSummary.of(recording),
      PredictionErrors.of(recording)
    )

  private def roles(recording: Recording): Vector[RoleSummary] =
    val roleOf = recording.heading.vehicles.map(vehicle => vehicle.name -> vehicle.role.toLowerCase).toMap
    recording.decisions
      .groupBy(decision => roleOf.getOrElse(decision.vehicle, ""))
      .toVector
      .sortBy(_._1)
      .map: (role, decisions) =>
        RoleSummary(
          role,
          Observation.values
            .flatMap(observation => Distribution.of(decisions.flatMap(observation.ms)).map(observation -> _))
            .toMap,
          Distribution.of(decisions.flatMap(_.trueAge).map(_.own.toMillis)),
          Distribution.of(decisions.flatMap(_.trueAge).map(_.opponent.toMillis))
        )

  private def roundTripsMs(recording: Recording): Option[Distribution] =
    val ofReadings = recording.readings.map(_.state.roundTrip)
    val ofLink     = recording.latencies.map(_.roundTrip)
    Distribution.of((if ofLink.nonEmpty then ofLink else ofReadings).map(_.toMillis))
