package skein.measure

import skein.identify.{ArrivedCommand, TimeHistory, Sample}
import skein.record.*
import skein.signal.OneWayDelays
import skein.units.*

/** Extracts from a recording how its vehicles responded to their commands. */
object FlownVehicles:

  /** The history of each commanded vehicle. All times are simulated times, from the recording's first
    * reading.
    *
    * The arrival time of a command is known while the simulator stood still (`paused`). Otherwise it is
    * estimated from the mean delays of the readings around it, and, if the previous command was answered as
    * superseded, from that answer's round trip ([[skein.signal.OneWayDelays.arrivalGiven]]). Commands whose
    * calls failed count only if such an answer shows that they arrived.
    */
  def of(recording: Recording): Vector[TimeHistory] =
    val start = recording.readings.map(_.state.validAt).minOption.getOrElse(Instant.Epoch)
    for
      vehicle <- recording.heading.vehicles.toVector
      commands = recording.commands.filter(_.vehicle == vehicle.name)
      if commands.nonEmpty
      arrivals = arrivalsOf(recording, vehicle.name, commands).map: (command, at) =>
        ArrivedCommand(at.since(start).toSeconds, command.velocityNorth.value, command.velocityEast.value)
      if arrivals.nonEmpty
    yield
      val samples = recording.readings
        .filter(_.vehicle == vehicle.name)
        .map(_.state)
        .distinctBy(_.validAt)
        .sortBy(_.validAt)
        .map: state =>
          val Vector3(x, y, _)   = state.value.positionNed
          val Vector3(vx, vy, _) = state.value.velocityNed
          Sample(state.validAt.since(start).toSeconds, x, y, vx, vy)
        // The command after its last recorded one, to hover, is not recorded.
        .takeWhile(_.atS <= arrivals.last.atS)
      TimeHistory(s"${recording.flight.id}, ${vehicle.name}", samples, arrivals, commands.last.down.value)

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
    private val byArrival = recording.readings.map(_.state).sortBy(_.receivedAt)
    private val times     = byArrival.map(_.receivedAt)
    private val known     = byArrival
      .drop(1)
      .scanLeft(byArrival.headOption.map(OneWayDelays.of))((delays, reading) =>
        delays.map(_.updated(reading))
      )

    def at(moment: Instant): Option[OneWayDelays] =
      known((times.search(moment).insertionPoint - 1).max(0))
