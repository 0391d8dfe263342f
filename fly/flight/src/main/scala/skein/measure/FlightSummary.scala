package skein.measure

import skein.loop.Reading
import skein.policy.Role
import skein.record.*
import skein.scenario.{Measure, Result, Scenario, Scenarios, Track, Tracks}
import skein.units.*
import skein.units.Decimals.fixed

/** The summary of one recording.
  *
  * @param simulator its name, its wire protocol if not AirSim's, and its bodies: for people
  * @param tracks empty if the flight has no result: no clock, or no vehicle, to measure by
  * @param roles evaders first, as in the paper
  * @param roundTripsMs round trips of the link's own samples if there are any, else of the readings
  * @param scenario absent if it is not known here
  * @param cutShort why it ended early, if it did
  * @param policy short name of the policy that replaced the paper's; the flight's scenario says more
  * @param planning absent if nothing was planned
  * @param predictions absent if nothing was predicted
  * @param paused time for which its vehicles hovered on request: included in all times and distances of the
  *   flight
  * @param seeing one summary for each eye of its scenario, also for one without detections
  * @param solver absent if the flight's own process decided
  * @param noResult why the flight has no result, if it has none
  * @param starved lateness of control on a machine that was too busy, if it was
  * @param commandAgesMs ages of commands that carry out a decision: from the sampling of the vehicle's own
  *   physics to the sending of the command
  * @param imageless its cameras without any of the requested images, each with the reason in a line
  * @param isInPacket whether its commands carried plans, to a buffer on the vehicle's side of the link
  * @param predictor what predicted its vehicles, as recorded; absent if its loop predicts nothing
  * @param movesInFlight maximum number of one vehicle's unanswered moves; absent if nothing limited them
  * @param options recorded settings of its loop by name, without usual ones ([[FlightOptions]])
  * @param apart options in which it differs from flights of its name that are shown with it ([[FlightSet]])
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
    imageless: Vector[String],
    isInPacket: Boolean,
    predictor: Option[String],
    movesInFlight: Option[Int],
    options: Vector[(String, String)],
    apart: String = ""
):

  /** The distance between the first pursuer and the first evader, if all play against one opponent each;
    * absent if they were not both read.
    */
  val distance: Option[DistanceCurve] =
    for
      pursuer <- tracks.find(_.isA(Role.Pursuer)) if scenario.forall(FlightSummary.isOfDuels)
      evader  <- tracks.find(_.isA(Role.Evader))
      curve   <- DistanceCurve.between(pursuer, evader)
    yield curve

  /** Absent if the scenario is not known, or some vehicle was not read. */
  val result: Option[Result] =
    for
      known <- scenario if tracks.map(_.vehicle) == known.agents.map(_.name)
      flown <- Tracks.of(tracks)
    yield Result.of(known, flown)

  /** The loop, the policy if it is not the paper's, whether a solver decided, and what prevents a comparison:
    * that it has no result, was cut short or paused, or that the machine was too busy. With other flights
    * also the options in which these differ.
    */
  def name: String = flownAs + apart + starved.filter(_ => noResult.isEmpty).fold("")(_ => ", starved")

  /** The name without differing options and the remark on a busy machine. */
  private[measure] def flownAs: String =
    val ended = noResult.map(none => s", no result: ${none.what}").orElse(cutShort.map(_ => ", cut short"))
    flight.loop + solver.fold("")(_ => ", solver") + policy.fold("")(policy => s", $policy") +
      ended.getOrElse("") + paused.fold("")(_ => ", paused")

  /** Whether it can be compared with other flights. */
  def isComparable: Boolean = cutShort.isEmpty && paused.isEmpty && noResult.isEmpty && starved.isEmpty

  def flownS: Double =
    distance.map(_.points.last._1).orElse(result.map(_.tracks.lastS)).getOrElse(0.0)

  /** The measure by which the flight is compared with others: its scenario's first. */
  def headlineOf: Option[Measure] = scenario.flatMap(_.measures.headOption)

  /** The value of the headline measure. None if it cannot be compared ([[isComparable]]). */
  def headline: Option[Double] =
    result.filter(_ => isComparable).flatMap(_.measured.headOption).flatMap(_.value)

  /** The paper's flight of this loop over this link, if this is of the paper's game, with equal duration and
    * period. None if this flight cannot be compared.
    */
  def published: Option[Published.Flight] =
    val isAlike = scenario.exists(_.isPapersGame) && flight.period == Published.Period &&
      flight.duration == Published.Duration && policy.isEmpty && solver.isEmpty && options.isEmpty
    if isAlike && isComparable then
      flight.loopKind.flatMap(Published.flight(_, flight.link))
    else None

  def count(kind: EventKind): Int = events.getOrElse(kind, 0)

/** The decisions for all vehicles of one role.
  *
  * @param opponentTrueAgeMs absent, like other observations of an opponent, if the role's policies consider
  *   the team instead
  * @param ownTrueAgeMs time from the sampling of physics to the decision
  */
final case class RoleSummary(
    role: String,
    observedMs: Map[TimingObservation, Distribution],
    ownTrueAgeMs: Option[Distribution],
    opponentTrueAgeMs: Option[Distribution]
):
  def hasOpponent: Boolean = observedMs.keys.exists(_.isOfOpponent)

object FlightSummary:
  /** The observations that tables show; those of an opponent only if some vehicle has one. */
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
      (recording.flight.simulator.label +: Seq(
        "wire",
        "plant",
        "sensors"
      ).flatMap(recording.heading.parameter))
        .mkString(", "),
      tracks,
      scenario,
      roles(recording, scenario, hasAges = noResult.isEmpty),
      roundTripsMs(recording),
      recording.readings.size,
      recording.decisions.size,
      recording.commands.size,
      recording.events.groupMapReduce(_.kind)(_.count.fold(1)(_.toInt))(_ + _),
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
      imageless(recording),
      recording.heading.parameter("planInPacket").contains("true"),
      Seq("predictor", "model").flatMap(recording.heading.parameter).headOption
        .filter(_ => recording.flight.loopKind.forall(Predicting)),
      recording.heading.parameter("movesInFlight").flatMap(_.toIntOption)
        .filter(_ => !recording.flight.isPaused),
      FlightOptions.of(recording)
    )

  private val Predicting = Set(LoopKind.Predictive, LoopKind.Plan)

  /** Its cameras without any of the images to be recorded, with the reasons. */
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

  /** Whether an age is valid: recordings of earlier versions have negative ages if the simulator's clock was
    * reset.
    */
  private def isAge(age: Span) = age >= Span.Zero

  private def isOfDuels(scenario: Scenario) = scenario.agents.forall(_.policy.isAgainstOne)

  /** Why the flight was cut short: by the record of its end, and else by the time for which its vehicles were
    * read.
    */
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

  /** Tolerance at both ends of a flight between its duration and its readings. */
  private val Margin = Span.ofSeconds(2)

  /** The summaries by role.
    *
    * @param hasAges whether true ages are valid: they are unless the flight has no result ([[NoResult]])
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
    val ofReadings = Reading.asked(recording).map(_.state.roundTrip)
    val ofLink     = recording.latencies.map(_.roundTrip)
    Distribution.of((if ofLink.nonEmpty then ofLink else ofReadings).map(_.toMillis))
