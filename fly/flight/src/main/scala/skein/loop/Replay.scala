package skein.loop

import skein.policy.Fleet
import skein.record.*
import skein.scenario.Scenarios
import skein.signal.{ClockAlignment, Kinematics, Stamped}
import skein.units.*

/** Repeats the decisions of a recorded flight, live or virtual, with the pure core of every loop: without
  * streams, without a clock.
  *
  * Taken from the recording: all readings, all moves, the time of each decision, which of the readings and
  * moves the controller knew then, the estimate of the clocks' offset, and, for a loop that predicts, its
  * predictions with their vehicles; for one that plans, the slices that each search had finished. Repeated,
  * and compared to the last bit: everything else in a decision, above all its opponent and the chosen
  * heading. The memory from decision to decision is the replay's own.
  *
  * @param settings the flight's settings; for a loop that does not plan, only its controllers' knowledge
  *   matters
  * @throws IllegalArgumentException if planning does not support the recorded models here
  */
final class Replay(fleet: Fleet, recording: Recording, settings: LoopSettings = LoopSettings())(using
    scenarios: Scenarios = Scenarios.ours
):
  import Replay.*

  private val rows     = Rows(fleet)
  private val paused   = recording.flight.isPaused
  private val indexOf  = fleet.agents.map(_.name).zipWithIndex.toMap
  private val readings =
    if paused then recording.readings.map(read => read.copy(state = PausedLoop.timeless(read.state)))
    else recording.readings
  private val bySequence  = readings.map(reading => (reading.vehicle, reading.sequence) -> reading).toMap
  private val controllers = Reading.controllers(recording.heading)

  /** The readings that each controller received, by controller and vehicle. */
  private val heard = Vector.tabulate(controllers): controller =>
    fleet.agents.map: agent =>
      Heard(
        readings.filter(read => read.vehicle == agent.name && read.sequence % controllers == controller).map(
          message
        )
      )
  private val sighted  = recording.sightings.groupBy(sighting => (sighting.decider, sighting.decision))
  private val measured = recording.measurements
    .map(read => (read.vehicle, read.sensor, read.sequence) -> read)
    .toMap
  private val sensings  = recording.sensings.groupBy(sensing => (sensing.vehicle, sensing.decision))
  private val missed    = decisionsOf(EventKind.DeadlineMissed)
  private val begunAnew = decisionsOf(EventKind.SolverRestarted)
  private val fallback  = recording.heading
    .parameter(Replay.Fallback)
    .flatMap(skein.loop.Fallback.parse(_).toOption)
    .getOrElse(skein.loop.Fallback.Repeat)
  private val moves = sentMoves.map(move => (move.vehicle, move.sentAt.toNanos) -> move).toMap

  private val planned =
    recording.planned.map(planned => (planned.vehicle, planned.decision) -> planned).toMap

  private val joint = Option
    .when(recording.flight.loopKind.contains(LoopKind.Plan) || recording.planned.nonEmpty)(())
    .flatMap(_ =>
      JointPlanning.of(fleet, settings.copy(seed = recording.flight.seed)).fold(
        reason => throw IllegalArgumentException(reason),
        identity
      )
    )
  private val planners = joint.fold(Vector.empty)(_.vehicles).map(fleet.agents(_).name)

  private def decisionsOf(kind: EventKind): Set[(String, Long)] =
    recording.events.filter(_.kind == kind).flatMap(event => event.vehicle.zip(event.decision)).toSet

  /** Decisions made jointly, by their time and vehicle. */
  private val together =
    recording.decisions
      .filter(decision => planners.contains(decision.vehicle))
      .groupBy(_.decidedAt)
      .view
      .mapValues(_.map(decision => decision.vehicle -> decision).toMap)
      .toMap

  /** The first decision whose repetition differs from the recording. */
  def firstDifference: Option[Difference] =
    val single = fleet.agents.indices.toVector.map: self =>
      val decider = Decider(fleet, self)
      SingleState(self, decider, decider.start): DecisionState
    val states = joint.fold(single): planning =>
      val together = JointState(planning, planning.vehicles.map(Decider(fleet, _).start))
      planning.vehicles.foldLeft(single)(_.updated(_, together))
    whole.iterator
      .scanLeft((Minds(states, Map.empty), Option.empty[Difference])): (state, recorded) =>
        again(state._1, recorded) match
          case Left(difference)          => (state._1, Some(difference))
          case Right((states, decision)) =>
            (states, Difference.between(withSpeed(recorded), withSpeed(decision)))
      .collectFirst { case (_, Some(difference)) => difference }

  /** A decision with its speed, even if it is the vehicle's own speed, which is not recorded. */
  private def withSpeed(decision: DecisionRow): DecisionRow =
    decision.copy(speed = decision.speed.orElse(indexOf.get(decision.vehicle).map(fleet.agents(_).speed)))

  /** All decisions except an incomplete final joint decision of a truncated recording. */
  private def whole: Vector[DecisionRow] =
    val cut = together.maxByOption(_._1).filter(_._2.size < planners.size).map(_._1)
    recording.decisions.filterNot(decision =>
      cut.contains(decision.decidedAt) && planners.contains(decision.vehicle)
    )

  private def again(minds: Minds, recorded: DecisionRow): Either[Difference, (Minds, DecisionRow)] =
    minds.decided.get(key(recorded)).fold(decidedAgain(minds, recorded))(decision => Right((minds, decision)))

  private def decidedAgain(minds: Minds, recorded: DecisionRow): Either[Difference, (Minds, DecisionRow)] =
    for
      self <- vehicle(recorded, "vehicle", recorded.vehicle)
      state = minds.states(self)
      all <- Expect.each(state.vehicles): other =>
        if other == self then Right(recorded) else decidedWith(recorded, fleet.agents(other).name)
      views <- Expect.each(state.vehicles.zip(all)): (vehicle, decision) =>
        view(decision, vehicle, state.regardsTeam(vehicle))
      isMissed = all.forall(decision => missed(key(decision)))
      slices <-
        if isMissed || !planners.contains(recorded.vehicle) then Right(Vector.empty) else searched(recorded)
    yield
      val before       = if all.exists(decision => begunAnew(key(decision))) then state.begunAnew else state
      val (next, made) =
        if isMissed then before.decideBy(state.vehicles.map(instead), views, recorded.decidedAt)
        else before.decide(views, recorded.decidedAt, slices)
      val decisions = made.map(rows.decision)
      // If its number is wrong, the comparison with the recorded decision finds that.
      val own     = decisions(state.vehicles.indexOf(self))
      val decided =
        if decisions.sizeIs == 1 then minds.decided
        else decisions.map(decision => key(decision) -> decision).toMap
      (Minds(state.vehicles.foldLeft(minds.states)(_.updated(_, next)), decided), own)

  private def decidedWith(recorded: DecisionRow, name: String): Either[Difference, DecisionRow] =
    together(recorded.decidedAt)
      .get(name)
      .toRight(Difference(where(recorded), "vehicle", name, "expected to decide at that time too"))

  private def view(recorded: DecisionRow, self: Int, regardsTeam: Boolean): Either[Difference, TeamView] =
    for
      other    <- vehicle(recorded, "opponentVehicle", recorded.opponent.vehicle)
      own      <- reading(recorded, "ownSequence", recorded.own)
      opponent <- reading(recorded, "opponentSequence", recorded.opponent)
      ownMove  <- move(recorded, "sinceOwnMoveMs", self, recorded.observations.sinceOwnMove)
      itsMove  <- move(recorded, "sinceOpponentMoveMs", other, recorded.observations.sinceOpponentMove)
      sensed   <- sensed(recorded, self)
      others   <- if regardsTeam then othersSeen(recorded, self, other) else Right(Map.empty)
    yield
      val empty = TeamView.empty(fleet.agents.size).copy(knows = settings.knows)
      val used  = empty.readings.updated(self, Some(own)).updated(other, Some(opponent))
      val known = empty.copy(
        readings = others.foldLeft(used)((used, seen) => used.updated(seen._1, Some(seen._2))),
        moves = empty.moves.updated(self, ownMove).updated(other, itsMove),
        alignment = recorded.trueAge.map(alignment),
        sensed = empty.sensed.updated(self, sensed)
      )
      val possible = views(known, recorded, heard(self % controllers))
      possible
        .find(view => fleet.opponentOf(self, view.kinematics(_).positionNed) == other)
        .getOrElse(possible.head)

  private def sensed(of: DecisionRow, self: Int): Either[Difference, Map[String, SensorReading]] =
    Expect
      .each(sensings.getOrElse(key(of), Vector.empty)): sensing =>
        measured
          .get((of.vehicle, sensing.sensor, sensing.measurement))
          .map: read =>
            val values = Stamped(read.numbers, read.validAt, read.sentAt, read.receivedAt)
            val timed  = if paused then PausedLoop.timeless(values) else values
            sensing.sensor -> SensorReading(self, sensing.sensor, read.sequence, read.quantities, timed)
          .toRight(
            Difference(
              where(of),
              sensing.sensor,
              s"measurement ${sensing.measurement}",
              "no such measurement"
            )
          )
      .map(_.toMap)

  /** The number of slices in each search of a decision. */
  private def searched(of: DecisionRow): Either[Difference, Vector[Int]] =
    planned
      .get(key(of))
      .map(_.slices.map(_.toInt))
      .toRight(Difference(where(of), "slices", "absent", "expected in the table of plans"))

  /** The decider of the fallback after a missed deadline. */
  private def instead(self: Int): Decider =
    fallback.policy(fleet.agents(self)).fold(Decider(fleet, self))(Decider(fleet, self, _))

  /** The readings of the rest of the team, if the policy considers it: every vehicle has one. */
  private def othersSeen(of: DecisionRow, self: Int, opponent: Int): Either[Difference, Map[Int, Reading]] =
    val rest = fleet.agents.indices.filter(index => index != self && index != opponent)
    Expect
      .each(rest): vehicle =>
        val name = fleet.agents(vehicle).name
        for
          sighting <- sightingOf(of, name).toRight(
            Difference(where(of), "sighting", name, "missing in the table of sightings")
          )
          reading <- bySequence
            .get((name, sighting.reading))
            .toRight(Difference(where(of), "sighting", s"$name ${sighting.reading}", "no such reading"))
        yield vehicle -> message(reading)
      .map(_.toMap)

  private def sightingOf(of: DecisionRow, vehicle: String): Option[Sighting] =
    sighted.getOrElse(key(of), Vector.empty).find(_.vehicle == vehicle)

  /** The candidate views with readings of vehicles that the decision did not use. The view was drawn at some
    * moment after the used readings were received, so there is one for each reading received since.
    */
  private def views(known: TeamView, recorded: DecisionRow, heard: Vector[Heard]): Vector[TeamView] =
    val earliest = recorded.own.state.receivedAt.max(recorded.opponent.state.receivedAt)
    val others   = fleet.agents.indices.filter(known.readings(_).isEmpty).toVector
    val moments  = others.flatMap(heard(_).between(earliest, recorded.decidedAt))
    for
      moment <- (earliest +: moments).distinct
      view = others.foldLeft(known): (view, other) =>
        view.copy(readings = view.readings.updated(other, heard(other).newestAt(moment)))
      if view.isComplete
    yield view.copy(estimates = recorded.predicted.map(estimates(view, recorded, _)))

  private def estimates(view: TeamView, recorded: DecisionRow, predicted: Predicted) =
    val states = planned.get(key(recorded)).flatMap(_.states)
    view.readings.flatten.map: reading =>
      val name               = rows.name(reading.vehicle)
      val read               = reading.state.value
      val (estimated, state) =
        if name == recorded.vehicle then
          (moved(read, predicted.ownPositionNed, predicted.ownVelocityNed), states.map(_.own))
        else if name == recorded.opponent.vehicle then
          (moved(read, predicted.opponentPositionNed, predicted.opponentVelocityNed), states.map(_.opponent))
        else
          sightingOf(recorded, name).flatMap(_.predicted) match
            case Some(motion) => (moved(read, motion.positionNed, motion.velocityNed), None)
            case None         => (moved(read, OutOfSight, read.velocityNed), None)
      skein.forecast.Estimate(
        estimated,
        predicted.actsAt,
        reading.state.validAt,
        state.getOrElse(Vector.empty)
      )

  private def moved(read: Kinematics, positionNed: Vector3, velocityNed: Vector3): Kinematics =
    read.copy(positionNed = positionNed, velocityNed = velocityNed)

  /** Bounds whose middle and half width are the recorded estimate. */
  private def alignment(age: TrueAge): ClockAlignment =
    val (least, most) = (age.clockOffset - age.uncertainty, age.clockOffset + age.uncertainty)
    ClockAlignment.of(Stamped((), Instant.Epoch, Instant.Epoch + least, Instant.Epoch + most))

  private def message(read: ReadingRow): Reading = Reading(indexOf(read.vehicle), read.sequence, read.state)

  private def vehicle(of: DecisionRow, column: String, name: String): Either[Difference, Int] =
    indexOf.get(name).toRight(Difference(where(of), column, name, "no vehicle of the scenario"))

  private def reading(of: DecisionRow, column: String, used: ReadingRow): Either[Difference, Reading] =
    bySequence.get((used.vehicle, used.sequence)) match
      case Some(read) if read == used => Right(message(read))
      case Some(read)                 =>
        Left(Difference(where(of), column, used.toString, s"another in the table of readings: $read"))
      case None =>
        Left(Difference(where(of), column, used.sequence.toString, "missing in the table of readings"))

  private def move(
      of: DecisionRow,
      column: String,
      vehicle: Int,
      since: Option[Span]
  ): Either[Difference, Option[SentCommand]] =
    Expect
      .each(since): span =>
        moves
          .get((vehicle, (of.decidedAt - span).toNanos))
          .toRight(Difference(where(of), column, span.toMillis.toString, "no command was sent then"))
      .map(_.headOption)

  /** The sent moves. While the simulator stands still, they are sent at the moment of their decision, on its
    * clock.
    */
  private def sentMoves: Vector[SentCommand] =
    val decided = recording.decisions.map(decision => key(decision) -> decision).toMap
    for
      command  <- recording.commands
      sequence <- command.decision
      decision <- decided.get((command.vehicle, sequence))
      vehicle  <- indexOf.get(command.vehicle)
    yield SentCommand(
      vehicle,
      sequence,
      decision.heading,
      if paused then decision.decidedAt else command.sentAt,
      rows.action(decision, fleet.agents(vehicle))
    )

  private def key(decision: DecisionRow): (String, Long) = (decision.vehicle, decision.sequence)

  private def where(decision: DecisionRow): String = s"decision ${decision.sequence} of ${decision.vehicle}"

object Replay:
  /** State of a replay.
    *
    * @param states by vehicle; those that plan together share one
    * @param decided decisions of the last joint round, by vehicle and sequence number
    */
  private final case class Minds(states: Vector[DecisionState], decided: Map[(String, Long), DecisionRow])

  /** The parameter that names the fallback for missed deadlines. */
  val Fallback: String = "fallback"

  /** A distant position: predictions of vehicles that are not the decision's opponent are not recorded. */
  private val OutOfSight = Vector3(Double.PositiveInfinity, 0, 0)

  /** The readings of one vehicle, indexed by time of receipt. */
  private final class Heard(readings: Vector[Reading]):
    private val byArrival = readings.sortBy(_.state.receivedAt)
    private val arrivals  = byArrival.map(_.state.receivedAt)
    private val newest    = byArrival.drop(1).scanLeft(byArrival.headOption): (newest, reading) =>
      newest.filter(_.state.validAt >= reading.state.validAt).orElse(Some(reading))

    /** The newest reading received by a moment. */
    def newestAt(moment: Instant): Option[Reading] = newest.take(arrivedBy(moment)).lastOption.flatten

    /** Times of receipt after one moment and up to another. */
    def between(after: Instant, until: Instant): Vector[Instant] =
      arrivals.slice(arrivedBy(after), arrivedBy(until))

    private def arrivedBy(moment: Instant): Int =
      arrivals.search(moment + Span.ofNanos(1)).insertionPoint
