package skein.measure

import skein.policy.Role
import skein.record.*
import skein.scenario.{Measure, Result, Scenario, Scenarios, Track, Tracks}
import skein.units.*
import skein.units.Decimals.fixed

/** What one recording comes to.
  *
  * @param simulator which it was, by what wire if not AirSim's, and of what bodies: for people
  * @param tracks none where the flight has no result: there is no clock, or no vehicle, to measure by
  * @param roles evaders first, as in the paper
  * @param roundTripsMs of the link's own samples where there are any, else of the readings
  * @param scenario absent where it is not known here
  * @param cutShort why it ended before its time, if it did
  * @param policy short name of the policy that was flown in the place of the paper's; the flight's scenario
  *   says more
  * @param planning absent where nothing was planned
  * @param predictions absent where nothing was predicted
  * @param paused for how long its vehicles were told to hover: that lies within all times and distances of
  *   the flight
  * @param seeing of each eye of its scenario, also of one that found nothing
  * @param solver absent where the flight's own process decided
  * @param noResult why the flight has no result, if it has none
  * @param starved how late control ran on a machine that was too busy, if it was
  * @param commandAgesMs of commands that carry out a decision: from when the vehicle's own physics was
  *   sampled to the command's sending
  * @param imageless its cameras of which images were wanted and none came, and why: a line each
  */
final case class FlightSummary(
    flight: FlightRow,
    simulator: String,
    tracks: Vector[Track],
    scenario: Option[Scenario],
    roles: Vector[RoleSummary],
    roundTripsMs: Option[Distribution],
    readings: Int,
    decisions: Int,
    commands: Int,
    events: Map[EventKind, Int],
    cutShort: Option[String],
    policy: Option[String],
    planning: Option[PlanningSummary],
    predictions: Option[(own: PredictionErrors, others: PredictionErrors)],
    paused: Option[Span],
    seeing: Vector[SeeingSummary],
    solver: Option[SolverSummary],
    commandAgesMs: Option[Distribution],
    noResult: Option[NoResult],
    starved: Option[String],
    imageless: Vector[String]
):

  /** Between the first pursuer and the first evader, where all fly against one opponent each; absent if they
    * were not both seen.
    */
  val distance: Option[DistanceCurve] =
    for
      pursuer <- tracks.find(_.isA(Role.Pursuer)) if scenario.forall(FlightSummary.isOfDuels)
      evader  <- tracks.find(_.isA(Role.Evader))
      curve   <- DistanceCurve.between(pursuer, evader)
    yield curve

  /** Absent where the scenario is not known, or the vehicles were not all seen. */
  val result: Option[Result] =
    for
      known <- scenario if tracks.map(_.vehicle) == known.agents.map(_.name)
      flown <- Tracks.of(tracks)
    yield Result.of(known, flown)

  /** The loop, the policy where it is not the paper's, whether a solver decided, and what stands in the way
    * of comparing it: that it has no result, was cut short or paused, or that the machine was too busy.
    */
  def name: String = flownAs + starved.filter(_ => noResult.isEmpty).fold("")(_ => ", starved")

  /** The same on whatever machine. */
  private[measure] def flownAs: String =
    val ended = noResult.map(none => s", no result: ${none.what}").orElse(cutShort.map(_ => ", cut short"))
    flight.loop + solver.fold("")(_ => ", solver") + policy.fold("")(policy => s", $policy") +
      ended.getOrElse("") + paused.fold("")(_ => ", paused")

  /** Whether it can be held against other flights. */
  def isComparable: Boolean = cutShort.isEmpty && paused.isEmpty && noResult.isEmpty && starved.isEmpty

  /** Time flown on the simulator's clock, s. */
  def flownS: Double =
    distance.map(_.points.last._1).orElse(result.map(_.tracks.lastS)).getOrElse(0.0)

  /** The measure that stands for the flight when it is compared with others: its scenario's first. */
  def headlineOf: Option[Measure] = scenario.flatMap(_.measures.headOption)

  /** What it comes to. Nothing, where it cannot be compared ([[isComparable]]). */
  def headline: Option[Double] =
    result.filter(_ => isComparable).flatMap(_.measured.headOption).flatMap(_.value)

  /** The paper's flight of this loop over this link, if this is of the paper's game, as long and with as long
    * a period. No flight that cannot be compared stands beside it.
    */
  def published: Option[Published.Flight] =
    val isAlike = scenario.exists(_.isPapersGame) && flight.period == Published.Period &&
      flight.duration == Published.Duration && policy.isEmpty && solver.isEmpty
    if isAlike && isComparable then
      flight.loopKind.flatMap(Published.flight(_, flight.link))
    else None

  def count(kind: EventKind): Int = events.getOrElse(kind, 0)

/** The decisions for all vehicles of one role.
  *
  * @param opponentTrueAgeMs absent, as what is observed of an opponent, where the role's policies regard the
  *   team instead
  * @param ownTrueAgeMs from when physics was sampled to the decision
  */
final case class RoleSummary(
    role: String,
    observedMs: Map[TimingObservation, Distribution],
    ownTrueAgeMs: Option[Distribution],
    opponentTrueAgeMs: Option[Distribution]
):
  def hasOpponent: Boolean = observedMs.keys.exists(_.isOfOpponent)

object FlightSummary:
  /** Those that stand in tables; what is of an opponent, where anybody has one. */
  def observations(flights: Seq[FlightSummary]): Vector[TimingObservation] =
    TimingObservation.values.toVector.filter(one =>
      !one.isOfOpponent || flights.exists(_.roles.exists(_.hasOpponent))
    )

  def of(recording: Recording)(using Scenarios): FlightSummary =
    val noResult = NoResult.of(recording)
    val tracks   = if noResult.isEmpty then RecordedTracks.of(recording) else Vector.empty
    val scenario = RecordedScenario.of(recording).toOption
    FlightSummary(
      recording.flight,
      (recording.flight.simulator.label +: Seq("wire", "plant").flatMap(recording.heading.parameter))
        .mkString(", "),
      tracks,
      scenario,
      roles(recording, scenario, hasAges = noResult.isEmpty),
      roundTripsMs(recording),
      recording.readings.size,
      recording.decisions.size,
      recording.commands.size,
      recording.events.groupMapReduce(_.kind)(_ => 1)(_ + _),
      cutShort(recording, tracks),
      recording.heading.parameter("policy"),
      PlanningSummary.of(recording),
      PredictionErrors.of(recording, scenario.forall(isOfDuels)),
      paused(recording),
      scenario.toVector.flatMap(_.eyes).flatMap(SeeingSummary.of(recording, _, tracks)),
      SolverSummary.of(recording),
      commandAgesMs(recording).filter(_ => noResult.isEmpty),
      noResult,
      recording.events.find(_.kind == EventKind.Starved).map(_.detail),
      imageless(recording)
    )

  /** Its cameras of which images were to be recorded and none came, and why. */
  private def imageless(recording: Recording): Vector[String] =
    for
      event <- recording.events
      if event.kind == EventKind.Refused && event.about.contains(EventSubject.Camera)
    yield s"${event.vehicle.getOrElse("")}'s camera ${event.detail}"

  private def commandAgesMs(recording: Recording): Option[Distribution] =
    val decided = recording.decisions.map(made => (made.vehicle, made.sequence) -> made).toMap
    Distribution.of:
      for
        command  <- recording.commands
        sequence <- command.decision
        decision <- decided.get((command.vehicle, sequence))
        age      <- decision.trueAge if isAge(age.own)
      yield (age.own + command.sentAt.since(decision.decidedAt)).toMillis

  /** Readings from the future are none: recordings of earlier versions have such ages where the simulator's
    * clock was set anew.
    */
  private def isAge(age: Span) = age >= Span.Zero

  private def isOfDuels(scenario: Scenario) = scenario.agents.forall(_.policy.isAgainstOne)

  /** By what is on record of its end, and else by how long its vehicles were seen. */
  private def cutShort(recording: Recording, tracks: Vector[Track]): Option[String] = recording.ending match
    case Some(Ending(_, EndingKind.Completed, _)) => None
    case Some(Ending(_, how, reason))             =>
      Some(reason.getOrElse(how.toString.toLowerCase(java.util.Locale.ROOT)))
    case None =>
      val seen = tracks.map(track => track.to.since(track.from)).maxOption.getOrElse(Span.Zero)
      recording.events
        .find(_.kind == EventKind.Aborted)
        .map(_.detail)
        .orElse(Option.when(seen + Margin < recording.flight.duration)(
          s"the recording breaks off after ${seen.toSeconds.fixed(1)} of " +
            s"${recording.flight.duration.toSeconds.fixed(1)} s"
        ))

  private def paused(recording: Recording): Option[Span] =
    val turns = recording.events.filter(event => Set(EventKind.Paused, EventKind.Continued)(event.kind))
    val end   = recording.ending.map(_.at).orElse(recording.decisions.lastOption.map(_.decidedAt))
    val times = turns.map(_.at) ++ Option.when(turns.size % 2 == 1)(end).flatten
    Option.when(times.size > 1)(times.grouped(2).collect { case Vector(from, to) =>
      to.since(from)
    }.reduce(_ + _))

  /** What may be missing at both ends of a flight between its time and its readings. */
  private val Margin = Span.ofSeconds(2)

  /** @param hasAges whether there is a clock that true ages could be of
    */
  private def roles(recording: Recording, scenario: Option[Scenario], hasAges: Boolean): Vector[RoleSummary] =
    val isOther                 = recording.heading.parameter("policy").isDefined
    def isAgainst(role: String) = isOther || scenario.forall(
      _.agents.exists(agent => agent.policy.isAgainstOne && agent.role.toString.equalsIgnoreCase(role))
    )
    val roleOf = recording.heading.vehicles.map(vehicle =>
      vehicle.name -> vehicle.role.toLowerCase(java.util.Locale.ROOT)
    ).toMap
    recording.decisions
      .groupBy(decision => roleOf.getOrElse(decision.vehicle, ""))
      .toVector
      .sortBy(_._1)
      .map: (role, decisions) =>
        val trueAges = decisions.flatMap(_.trueAge).filter(_ => hasAges)
        RoleSummary(
          role,
          TimingObservation.values
            .filter(!_.isOfOpponent || isAgainst(role))
            .flatMap(observation => Distribution.of(decisions.flatMap(observation.ms)).map(observation -> _))
            .toMap,
          Distribution.of(trueAges.map(_.own).filter(isAge).map(_.toMillis)),
          Distribution.of(
            trueAges.filter(_ => isAgainst(role)).map(_.opponent).filter(isAge).map(_.toMillis)
          )
        )

  private def roundTripsMs(recording: Recording): Option[Distribution] =
    val ofReadings = recording.readings.map(_.state.roundTrip)
    val ofLink     = recording.latencies.map(_.roundTrip)
    Distribution.of((if ofLink.nonEmpty then ofLink else ofReadings).map(_.toMillis))
