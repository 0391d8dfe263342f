package skein.forecast

import skein.signal.{Kinematics, OneWayDelays, Stamped}
import skein.units.*
import skein.vehicle.{Setpoint, VehicleModel}

/** The forecast of one vehicle: its newest readings, and the commands that are in effect or under way.
  * Instants are on the controller's clock; `validAt` and everything named after it are on the simulator's.
  *
  * @param state the model's state at the newest reading
  * @param readings the newest readings, the newest last
  * @param resting setpoint in effect before the first command
  * @param before the command in effect before the first of `commands`; None for `resting`
  * @param commands sent commands in the order of sending: the one in effect at the newest reading, and all
  *   later ones
  */
final case class VehicleForecast[S] private (
    model: VehicleModel[S],
    state: S,
    readings: Vector[Stamped[Kinematics]],
    resting: Setpoint,
    before: Option[Commanded],
    commands: Vector[Commanded]
):
  def newest: Stamped[Kinematics] = readings.last

  /** Adds a reading: the model predicts the state at its time under the commands in effect, and the reading
    * corrects it. A reading that is not newer than all before changes nothing.
    */
  def seen(reading: Stamped[Kinematics], delays: OneWayDelays): VehicleForecast[S] =
    if reading.validAt <= newest.validAt then this
    else
      val flown          = advancedTo(reading.validAt, delays, reading.receivedAt)
      val (past, needed) = commands.splitAt(inEffect(reading.validAt, delays, reading.receivedAt))
      copy(
        state = model.corrected(flown, reading.value, reading.validAt.since(newest.validAt)),
        readings = (readings :+ reading).takeRight(VehicleForecast.ReadingLimit),
        before = past.lastOption.orElse(before),
        commands = needed
      )

  /** Adds the first reading of a simulator that has restarted with an earlier clock. The state starts from
    * this reading only, and earlier predictions are discarded.
    */
  def startedAgain(reading: Stamped[Kinematics]): VehicleForecast[S] =
    copy(state = model.start(reading.value), readings = Vector(reading))

  def sent(command: Commanded): VehicleForecast[S] =
    copy(commands = (commands :+ command).takeRight(VehicleForecast.CommandLimit))

  /** Adds the actions of a plan. They replace the actions of earlier plans from the plan's first time on, as
    * in [[skein.port.PlanBuffer]]. The plan is assumed to arrive in time; if it does not, the actions of an
    * earlier plan act, which are nearly equal.
    */
  def planned(plan: Vector[Commanded]): VehicleForecast[S] =
    val from = plan.headOption.flatMap(_.actsAt)
    val kept = commands.filterNot(_.actsAt.exists(acts => from.exists(acts >= _)))
    copy(commands = (kept ++ plan).takeRight(VehicleForecast.CommandLimit))

  /** Processes a report that a command was replaced, and thus that its successor has arrived. Changes nothing
    * if the successor took effect before all commands that are stored here.
    */
  def replaced(sequence: Long, answeredAt: Instant): VehicleForecast[S] =
    val successor = commands.indexWhere(_.sequence > sequence)
    if successor < 0 || before.exists(_.sequence > sequence) then this
    else
      copy(commands = commands.updated(successor, commands(successor).copy(answeredAt = Some(answeredAt))))

  /** Processes a failed call. Its command is presumed lost, unless it is known to have arrived or is already
    * in effect.
    */
  def failed(sequence: Long): VehicleForecast[S] =
    copy(commands =
      commands.take(1) ++ commands.drop(1).filterNot(command =>
        command.sequence == sequence && command.answeredAt.isEmpty && command.actsAt.isEmpty
      )
    )

  /** The estimate at a time on the simulator's clock, or at the newest reading if that is later. */
  def estimateAt(validAt: Instant, delays: OneWayDelays, now: Instant): Estimate =
    courseAt(validAt, delays, now).estimate

  /** The vehicle at the time of [[estimateAt]], from which further commands can be simulated. */
  def courseAt(validAt: Instant, delays: OneWayDelays, now: Instant): Course[S] =
    val at = validAt.max(newest.validAt)
    Course(model, advancedTo(at, delays, now), at, newest.validAt)

  /** The vehicle's position at a time on the simulator's clock, by cubic interpolation between the readings
    * before and after it. None without two such readings within [[VehicleForecast.MaxGap]] of each other.
    */
  def positionNedAt(validAt: Instant): Option[Vector3] =
    readings
      .zip(readings.drop(1))
      .find((before, after) =>
        before.validAt <= validAt && validAt <= after.validAt &&
          after.validAt.since(before.validAt) <= VehicleForecast.MaxGap
      )
      .map(VehicleForecast.between(_, _, validAt))

  /** The legs of the predicted flight from the newest reading until a time on the simulator's clock. If that
    * time is not later than the reading, the last leg has no duration.
    */
  def legsTo(validAt: Instant, delays: OneWayDelays, now: Instant): Vector[Leg] =
    val until  = validAt.max(newest.validAt)
    val legs   = Vector.newBuilder[Leg]
    var flying = before
    var at     = newest.validAt
    for (command, actsAt) <- effects(delays, now).takeWhile((_, actsAt) => actsAt < until) do
      val acts = actsAt.max(at)
      legs += Leg(flying, acts.since(at))
      flying = Some(command)
      at = acts
    legs += Leg(flying, until.since(at))
    legs.result()

  private def advancedTo(validAt: Instant, delays: OneWayDelays, now: Instant): S =
    legsTo(validAt, delays, now).foldLeft(state): (flown, leg) =>
      Course.guided(model, flown, leg.command.fold(resting)(_.guidance), leg.span)

  /** Commands with the times at which they take effect, on the simulator's clock. None takes effect before an
    * earlier one, because the connection keeps their order. Commands of plans have times of their own.
    */
  private def effects(delays: OneWayDelays, now: Instant): Iterator[(Commanded, Instant)] =
    var latest = Option.empty[Instant]
    commands.iterator
      .filterNot(isPresumedLost(_, delays, now))
      .map: command =>
        val arrives = command.actsAt.getOrElse:
          command.answeredAt.fold(delays.expectedArrival(command.sentAt)):
            delays.arrivalGiven(command.sentAt, _)
        val acts = latest.fold(arrives)(_.max(arrives))
        latest = Some(acts)
        (command, acts)

  /** Whether a command is presumed lost because its acknowledgement is overdue. This excludes the oldest
    * stored command, because one command is always in effect, and commands of plans, because others replace a
    * lost one.
    */
  private def isPresumedLost(command: Commanded, delays: OneWayDelays, now: Instant): Boolean =
    command.answeredAt.isEmpty && command.actsAt.isEmpty && command != commands.head &&
      now.since(command.sentAt) > delays.roundTrip * 2 + VehicleForecast.Grace

  /** Index of the command in effect; 0 if there is none. */
  private def inEffect(validAt: Instant, delays: OneWayDelays, now: Instant): Int =
    effects(delays, now)
      .takeWhile((_, actsAt) => actsAt <= validAt)
      .reduceOption((_, later) => later)
      .fold(0)((command, _) => commands.indexOf(command))

object VehicleForecast:
  /** Number of stored readings, with which predictions are compared. */
  val ReadingLimit = 8

  /** Number of stored commands, and thus the maximum number of commands under way. */
  val CommandLimit = 64

  /** Time beyond two round trips after which a command is presumed lost. */
  val Grace: Span = Span.ofMillis(500)

  /** Longest gap between two readings over which a position is interpolated. The cubic's error grows with the
    * fourth power of the gap, and is about 5 mm at this one.
    */
  val MaxGap: Span = Span.ofMillis(300)

  /** The forecast of a vehicle after its first reading; the vehicle is assumed to hold its position until its
    * first command.
    */
  def apply[S](model: VehicleModel[S], first: Stamped[Kinematics]): VehicleForecast[S] =
    new VehicleForecast(
      model,
      model.start(first.value),
      Vector(first),
      Setpoint.hold(first.value.positionNed),
      None,
      Vector.empty
    )

  private def between(before: Stamped[Kinematics], after: Stamped[Kinematics], validAt: Instant): Vector3 =
    val length = after.validAt.since(before.validAt).toSeconds
    val u      = validAt.since(before.validAt).toSeconds / length
    before.value.positionNed * ((1 + 2 * u) * (1 - u) * (1 - u)) +
      before.value.velocityNed * (u * (1 - u) * (1 - u) * length) +
      after.value.positionNed * (u * u * (3 - 2 * u)) +
      after.value.velocityNed * (u * u * (u - 1) * length)
