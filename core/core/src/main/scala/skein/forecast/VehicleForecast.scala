package skein.forecast

import scala.annotation.tailrec
import skein.signal.{Kinematics, OneWayDelays, Stamped}
import skein.units.*
import skein.vehicle.{Guidance, Setpoint, VehicleModel}

/** The forecast of one vehicle: its newest readings and the commands that act on it or are on their way.
  * Instants are the controller's, except where they come from the simulator: `validAt` and everything named
  * after it.
  *
  * @param state the model's, at the newest reading
  * @param readings the newest readings, the newest last
  * @param resting in effect before the first of all commands
  * @param before in effect before the first of `commands`; absent: `resting`
  * @param commands in the order of their sending: the one in effect at the newest reading, and all later ones
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

  /** Takes a reading: the model flies to it under the commands in effect, and is corrected by it. A reading
    * that is not newer than the newest changes nothing.
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

  /** Takes the first reading by a simulator that has started again with an earlier clock: where the vehicle
    * is does not follow from where it was, and what was predicted before is never read.
    */
  def startedAgain(reading: Stamped[Kinematics]): VehicleForecast[S] =
    copy(state = model.start(reading.value), readings = Vector(reading))

  def sent(command: Commanded): VehicleForecast[S] =
    copy(commands = (commands :+ command).takeRight(VehicleForecast.CommandLimit))

  /** The vehicle answered that a command was replaced: so the one after it has arrived. Where that one was in
    * effect before all that are held, it tells nothing of these.
    */
  def replaced(sequence: Long, answeredAt: Instant): VehicleForecast[S] =
    val successor = commands.indexWhere(_.sequence > sequence)
    if successor < 0 || before.exists(_.sequence > sequence) then this
    else
      copy(commands = commands.updated(successor, commands(successor).copy(answeredAt = Some(answeredAt))))

  /** A call failed: unless its command is known to have arrived, or the vehicle already flies under it, it is
    * taken for lost.
    */
  def failed(sequence: Long): VehicleForecast[S] =
    copy(commands =
      commands.take(1) ++ commands.drop(1).filterNot(command =>
        command.sequence == sequence && command.answeredAt.isEmpty
      )
    )

  /** The estimate at an instant on the simulator's clock; not before the newest reading. */
  def estimateAt(validAt: Instant, delays: OneWayDelays, now: Instant): Estimate =
    val at    = validAt.max(newest.validAt)
    val flown = advancedTo(at, delays, now)
    Estimate(model.kinematics(flown), at, newest.validAt, model.numbers(flown))

  /** Where the vehicle was at an instant on the simulator's clock, by the cubic through the two readings
    * around it; absent where there are none, or none close enough together.
    */
  def positionNedAt(validAt: Instant): Option[Vector3] =
    readings
      .zip(readings.drop(1))
      .find((before, after) =>
        before.validAt <= validAt && validAt <= after.validAt &&
          after.validAt.since(before.validAt) <= VehicleForecast.MaxGap
      )
      .map(VehicleForecast.between(_, _, validAt))

  /** What the vehicle flies through from the newest reading until an instant on the simulator's clock, by
    * what is known now; up to the reading itself where that is not before it.
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
      guided(flown, leg.command.fold(resting)(_.guidance), leg.span)

  private def guided(from: S, guidance: Guidance, span: Span): S =
    val period                                  = guidance.period.getOrElse(span)
    @tailrec def flown(state: S, left: Span): S =
      val part = left.min(period)
      val next = model.advanced(state, guidance.setpoint(model.kinematics(state)), part)
      if part < left then flown(next, left - part) else next
    flown(from, span)

  /** Commands that act, and when, on the simulator's clock. On an ordered connection none acts before one
    * sent earlier.
    */
  private def effects(delays: OneWayDelays, now: Instant): Iterator[(Commanded, Instant)] =
    var latest = Option.empty[Instant]
    commands.iterator
      .filterNot(isPresumedLost(_, delays, now))
      .map: command =>
        val arrives = command.answeredAt.fold(delays.expectedArrival(command.sentAt)):
          delays.arrivalGiven(command.sentAt, _)
        val acts = latest.fold(arrives)(_.max(arrives))
        latest = Some(acts)
        (command, acts)

  /** A command is taken for lost when its arrival should have been heard of long ago. The oldest held one
    * never is: the vehicle flies under something.
    */
  private def isPresumedLost(command: Commanded, delays: OneWayDelays, now: Instant): Boolean =
    command.answeredAt.isEmpty && command != commands.head &&
      now.since(command.sentAt) > delays.roundTrip * 2 + VehicleForecast.Grace

  /** Index of the command in effect; 0 if there is none. */
  private def inEffect(validAt: Instant, delays: OneWayDelays, now: Instant): Int =
    effects(delays, now)
      .takeWhile((_, actsAt) => actsAt <= validAt)
      .reduceOption((_, later) => later)
      .fold(0)((command, _) => commands.indexOf(command))

object VehicleForecast:
  /** Readings remembered, to hold predictions against. */
  val ReadingLimit = 8

  /** Commands remembered: at most these can be on their way. */
  val CommandLimit = 64

  /** On top of two round trips, before a command is presumed lost. */
  val Grace: Span = Span.ofMillis(500)

  /** Between two readings, for a position between them to be interpolated: the cubic's error grows with its
    * fourth power, to about 5 mm here.
    */
  val MaxGap: Span = Span.ofMillis(300)

  /** The track of a vehicle seen for the first time; until it is commanded it holds its place. */
  def apply[S](model: VehicleModel[S], first: Stamped[Kinematics]): VehicleForecast[S] =
    new VehicleForecast(
      model,
      model.start(first.value),
      Vector(first),
      Setpoint.hold(first.value.positionNed),
      None,
      Vector.empty
    )

  /** Cubic Hermite interpolation of positions and velocities. */
  private def between(before: Stamped[Kinematics], after: Stamped[Kinematics], validAt: Instant): Vector3 =
    val length = after.validAt.since(before.validAt).toSeconds
    val u      = validAt.since(before.validAt).toSeconds / length
    before.value.positionNed * ((1 + 2 * u) * (1 - u) * (1 - u)) +
      before.value.velocityNed * (u * (1 - u) * (1 - u) * length) +
      after.value.positionNed * (u * u * (3 - 2 * u)) +
      after.value.velocityNed * (u * u * (u - 1) * length)

/** Where a vehicle is taken to be.
  *
  * @param predictedFor the simulator's time at which this is expected to be true
  * @param readAt the simulator's time of the reading that it was carried forward from
  * @param state of its plant, as numbers, where kinematics do not tell all of it
  */
final case class Estimate(
    kinematics: Kinematics,
    predictedFor: Instant,
    readAt: Instant,
    state: Vector[Double] = Vector.empty
):

  /** How far the reading was carried. */
  def age: Span = predictedFor.since(readAt)
