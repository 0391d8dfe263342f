package skein.measure

import skein.identify.{ArrivedCommand, TimeHistory, Sample}
import skein.loop.Reading
import skein.policy.Action
import skein.record.*
import skein.signal.OneWayDelays
import skein.units.*
import skein.vehicle.VehicleKind

/** How a vehicle of a recording responded to its commands.
  *
  * @param stretches its flight, without pauses and without the commands that are no velocities
  */
final case class FlownVehicle(name: String, kind: VehicleKind, stretches: Vector[TimeHistory])

/** Extracts from a recording how its vehicles responded to their commands. */
object FlownVehicles:

  /** The commanded vehicles. All times are simulated times, from the recording's first reading.
    *
    * The arrival time of a command is known while the simulator stood still (`paused`). Otherwise it is
    * estimated from the mean delays of the readings around it, and, if the previous command was answered as
    * superseded, from that answer's round trip ([[skein.signal.OneWayDelays.arrivalGiven]]). Commands whose
    * calls failed count only if such an answer shows that they arrived.
    */
  def of(recording: Recording): Vector[FlownVehicle] =
    val start = recording.readings.map(_.state.validAt).minOption.getOrElse(Instant.Epoch)
    val turns = recording.events.collect:
      case event if event.kind == EventKind.Paused || event.kind == EventKind.Continued => event.at
    for
      vehicle <- recording.heading.vehicles.toVector
      commands = recording.commands.filter(_.vehicle == vehicle.name)
      if commands.nonEmpty
    yield
      val states = recording.readings
        .filter(_.vehicle == vehicle.name)
        .map(_.state)
        .distinctBy(_.validAt)
        .sortBy(_.validAt)
      val actions                = actionsOf(recording, vehicle.name)
      val arrived                = arrivalsOf(recording, vehicle.name, commands)
      def secondsAt(at: Instant) = at.since(start).toSeconds
      val stretches              =
        stretchesOf(arrived)((command, _) => stretchOf(actions(command), turns.count(_ <= command.sentAt)))
          .map: stretch =>
            // Nothing is known of the vehicle's command before, except at the start, where it hovers.
            val from = Option.when(stretch.head != arrived.head)(stretch.head._2)
            // The command after the last one, to hover for example, is not recorded.
            val sampled =
              states.dropWhile(state => from.exists(_ > state.validAt)).takeWhile(
                _.validAt <= stretch.last._2
              )
            TimeHistory(
              s"${recording.flight.id}, ${vehicle.name}",
              sampled.map: state =>
                val Vector3(x, y, _)   = state.value.positionNed
                val Vector3(vx, vy, _) = state.value.velocityNed
                Sample(secondsAt(state.validAt), x, y, vx, vy)
              ,
              stretch.map((command, at) => ArrivedCommand(secondsAt(at), actions(command))),
              sampled.headOption.fold(0.0)(_.value.positionNed.z)
            )
      FlownVehicle(vehicle.name, kindOf(recording, vehicle.name), stretches.filter(_.samples.nonEmpty))

  private def kindOf(recording: Recording, vehicle: String) =
    val isCar = VehicleRow.kind(vehicle, VehicleKind.Car).exists(recording.heading.parameters.contains)
    if isCar then VehicleKind.Car else VehicleKind.Multirotor

  private def actionsOf(recording: Recording, vehicle: String): CommandRow => Action =
    val recorded = recording.decisions
      .filter(_.vehicle == vehicle)
      .flatMap(decision => decision.action.map(decision.sequence -> _))
      .toMap
    command =>
      command.decision
        .flatMap(recorded.get)
        .getOrElse(
          Action.VelocityAt(command.velocityNorth.value, command.velocityEast.value, command.down)
        )

  /** The number of a command's stretch; None if it is no velocity, or was sent in a pause.
    *
    * @param turns number of beginnings and ends of pauses before it
    */
  private def stretchOf(action: Action, turns: Int): Option[Int] = action match
    case _: (Action.Velocity | Action.VelocityAt) if turns % 2 == 0 => Some(turns)
    case _ => None

  /** Groups successive elements with equal keys, and omits those without a key. */
  private def stretchesOf[A](all: Vector[A])(key: A => Option[Int]): Vector[Vector[A]] =
    all
      .map(one => (one, key(one)))
      .foldLeft(Vector.empty[Vector[(A, Option[Int])]]): (stretches, next) =>
        stretches.lastOption match
          case Some(last) if last.head._2 == next._2 => stretches.init :+ (last :+ next)
          case _                                     => stretches :+ Vector(next)
      .filter(_.head._2.isDefined)
      .map(_.map(_._1))

  /** Commands that arrived, with their arrival times on the simulator's clock: never before that of an
    * earlier command.
    */
  private def arrivalsOf(
      recording: Recording,
      vehicle: String,
      commands: Vector[CommandRow]
  ): Vector[(CommandRow, Instant)] =
    if recording.flight.isPaused then
      val decidedAt =
        recording.decisions.filter(_.vehicle == vehicle).map(decision =>
          decision.sequence -> decision.decidedAt
        ).toMap
      for
        command <- commands
        at      <- command.decision.flatMap(decidedAt.get)
      yield (command, at)
    else
      val delays = Delays(recording)
      val ends  = recording.acknowledgements.filter(_.vehicle == vehicle).map(end => end.command -> end).toMap
      val timed =
        for
          (command, before) <- commands.zip(None +: commands.map(Some(_)))
          end      = ends.get(command.sequence)
          answered = before
            .flatMap(earlier => ends.get(earlier.sequence))
            .filter(end => end.outcome == CommandOutcome.Superseded && end.endedAt >= command.sentAt)
          if answered.isDefined || end.forall(!_.outcome.isInstanceOf[CommandOutcome.Failed])
          known <- delays.at(answered.fold(command.sentAt)(_.endedAt))
        yield (
          command,
          answered.fold(known.expectedArrival(command.sentAt))(end =>
            known.arrivalGiven(command.sentAt, end.endedAt)
          )
        )
      if timed.isEmpty then timed
      else timed.map(_._1).zip(timed.map(_._2).scanLeft(timed.head._2)(_.max(_)).drop(1))

  /** The mean delays as they were known when each reading was received. */
  private final class Delays(recording: Recording):
    private val byArrival = Reading.asked(recording).map(_.state).sortBy(_.receivedAt)
    private val times     = byArrival.map(_.receivedAt)
    private val known     = byArrival
      .drop(1)
      .scanLeft(byArrival.headOption.map(OneWayDelays.of))((delays, reading) =>
        delays.map(_.updated(reading))
      )

    def at(moment: Instant): Option[OneWayDelays] =
      known((times.search(moment).insertionPoint - 1).max(0))
