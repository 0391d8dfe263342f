package skein.torture

import skein.loop.{LoopKind, FlightOutcome}
import skein.port.Moves
import skein.record.{DecisionRow, EventSubject, Recording}
import skein.units.*
import skein.units.Decimals.fixed

/** Checks a flight by its [[FlightTrace]], observed from outside. */
object Checks:

  /** All violations of a flight's guarantees, one line each. */
  def violations(seen: FlightTrace): Vector[String] =
    Vector(
      overtaken(seen),
      outstanding(seen),
      tooFast(seen),
      unended(seen),
      unaccounted(seen),
      unseen(seen),
      unbounded(seen),
      outOfControl(seen),
      restless(seen),
      standingStill(seen),
      notToldToHover(seen),
      notInTheFile(seen),
      KnowledgeChecks.violations(seen)
    ).flatten

  /** Moves must arrive in the order of sending. */
  private def overtaken(seen: FlightTrace): Vector[String] =
    for
      (vehicle, port) <- seen.vehicles.zip(seen.ports)
      late            <- firstOutOfOrder(
        seen.arrivals.filter(_.vehicle == vehicle).map(arrival => (arrival.north, arrival.east)),
        port.sendings.map(sending => (sending.north, sending.east))
      )
    yield s"$vehicle: a command overtook a newer one: arrival $late came after one that was sent later"

  /** Index of the first element of `arrived` that does not follow its predecessor in `sent`. */
  private[torture] def firstOutOfOrder[A](arrived: Vector[A], sent: Vector[A]): Option[Int] =
    var place = 0
    arrived.indices.find: index =>
      val found = sent.indexOf(arrived(index), place)
      place = found + 1
      found < 0

  private def outstanding(seen: FlightTrace): Vector[String] =
    for (vehicle, port) <- seen.vehicles.zip(seen.ports) if port.commands.most > Moves.InFlight
    yield s"$vehicle: ${port.commands.most} commands were outstanding at once"

  /** Commands must keep their minimum interval. While the simulator stands still no time passes between
    * commands.
    */
  private def tooFast(seen: FlightTrace): Vector[String] =
    for
      (vehicle, port) <- seen.vehicles.zip(seen.ports) if seen.faultPlan.loop != LoopKind.Paused
      (one, next)     <- port.sendings.zip(port.sendings.drop(1)).find: (one, next) =>
        next.at.since(one.at) < seen.settings.minCommandInterval
    yield s"$vehicle: two commands within " +
      s"${next.at.since(one.at).toMillis.fixed(3)} ms, at ${ms(seen, one.at)}"

  private def unended(seen: FlightTrace): Vector[String] =
    val calls =
      for
        (vehicle, port) <- seen.vehicles.zip(seen.ports)
        (what, count)   <-
          Seq("read" -> port.reads, "command" -> port.commands, "sensor" -> port.measurements)
        if count.begun != count.ended
      yield s"$vehicle: ${count.begun} $what calls began, ${count.ended} ended"
    calls ++ Option.when(seen.steps.begun != seen.steps.ended)(
      s"${seen.steps.begun} calls of the stepper began, ${seen.steps.ended} ended"
    ) ++ Option.when(
      seen.stats.pending != 0
    )(s"the client has ${seen.stats.pending} calls that never ended")

  /** Counts of begun and ended calls must agree in the client, the ports and the recording. */
  private def unaccounted(seen: FlightTrace): Vector[String] =
    val called = seen.ports.map(port =>
      port.reads.begun + port.commands.begun + port.measurements.begun
    ).sum.toLong +
      seen.steps.begun + seen.callsBeside + seen.images.map(_.asked).sum
    val stats   = seen.stats
    val written = stats.sent - stats.sentAgain
    Vector(
      Option.when(
        stats.called != called
      )(s"the client was to be called $called times, and was ${stats.called} times"),
      Option.when(written > stats.called)(s"$written calls were written of ${stats.called}"),
      Option.when(written < stats.answered + stats.refused + stats.lost)(
        s"${stats.answered} answered, ${stats.refused} refused and " +
          s"${stats.lost} lost of $written that were written"
      ),
      Option.when(seen.arrivals.size > seen.ports.map(_.sendings.size).sum)(
        s"${seen.arrivals.size} moves arrived of ${seen.ports.map(_.sendings.size).sum}"
      )
    ).flatten ++ (if isRecorded(seen) then unrecorded(seen) else Vector.empty)

  /** Every due image must be searched, or counted as missed or lost. */
  private def unseen(seen: FlightTrace): Vector[String] =
    for counts <- seen.images if counts.due != counts.missed + counts.lost + counts.searched
    yield s"of ${counts.due} images that were due ${counts.missed} were " +
      s"missed, ${counts.lost} lost, ${counts.searched} searched"

  private def unrecorded(seen: FlightTrace): Vector[String] =
    val recording = seen.recording
    seen.vehicles.zip(seen.ports).flatMap: (vehicle, port) =>
      def count[A](rows: Vector[A])(of: A => Boolean) = rows.count(of)
      val readings                                    = count(recording.readings)(_.vehicle == vehicle)
      val failed                                      =
        count(recording.events)(e =>
          e.vehicle.contains(vehicle) && e.about.contains(EventSubject.Reading)
        )
      val commands  = count(recording.commands)(_.vehicle == vehicle)
      val ended     = count(recording.acknowledgements)(_.vehicle == vehicle)
      val decisions = count(recording.decisions)(_.vehicle == vehicle)
      Vector(
        Option.when(readings + failed != port.reads.begun)(
          s"$vehicle: ${port.reads.begun} readings were asked for; $readings and $failed errors are on record"
        ),
        Option.when(commands != port.sendings.size)(
          s"$vehicle: ${port.sendings.size} commands were sent, $commands are on record"
        ),
        Option.when(ended != commands)(s"$vehicle: $commands commands are on record, and the ends of $ended"),
        Option.when(decisions < commands)(s"$vehicle: $decisions decisions led to $commands commands")
      ).flatten

  /** Whether the recording is complete: one that failed holds only the beginning. */
  private def isRecorded(seen: FlightTrace): Boolean = seen.outcome match
    case FlightOutcome.Failed(_) => false
    case _                       => true

  private def unbounded(seen: FlightTrace): Vector[String] =
    // Each sensor that a policy reads is requested separately from the vehicle.
    val sensors = seen.faultPlan.scenario.agents.map(_.policy.sensors.size).sum
    val most    = seen.vehicles.size.toLong * (seen.settings.window + Moves.InFlight + SignsOfLife) +
      sensors * seen.settings.window + seen.images.size * ImagesOnTheWay
    // Steps may take no time on the controller's clock: then they measure the flight's length.
    val flown =
      seen.endedAt.since(seen.startedAt).toSeconds.max(seen.steps.begun * seen.settings.period.toSeconds) + 1
    val rows = Recorded.rows(seen.recording)
    val each =
      if seen.faultPlan.scenario.isAsPublished then RowsPerSecond + 20 * seen.vehicles.size
      else RowsPerSecond
    val allowed = seen.vehicles.size * flown * each
    Vector(
      Option.when(
        seen.mostPending > most
      )(s"${seen.mostPending} calls were under way at once, of $most at most"),
      Option.when(seen.mostUnanswered > MostUnanswered)(
        s"the simulator had ${seen.mostUnanswered} unanswered moves of one vehicle"
      ),
      Option.when(rows > allowed)(s"$rows rows were recorded; ${allowed.fixed(0)} are many for this flight")
    ).flatten

  /** After the last fault, every vehicle must soon be commanded again, on readings since then, and
    * continuously. Except in a paused flight, which ends at the first error.
    */
  private def outOfControl(seen: FlightTrace): Vector[String] =
    val due = seen.calmFrom + FaultPlan.ResumesWithin
    if seen.outcome != FlightOutcome.Completed || seen.endedAt < due || seen.faultPlan.loop == LoopKind.Paused
    then
      Vector.empty
    else
      seen.vehicles.flatMap: vehicle =>
        val decided = seen.recording.decisions.exists(decision =>
          isFresh(seen, decision, vehicle) && decision.decidedAt < due
        )
        val until   = seen.endedAt.min(seen.startedAt + seen.faultPlan.duration)
        val moments =
          seen.arrivals.filter(_.vehicle == vehicle).map(_.at).filter(at => at >= seen.calmFrom && at < until)
        val gaps = (due +: moments.filter(_ > due)).zip(moments.filter(_ > due) :+ until).map((from, to) =>
          to.since(from)
        )
        Vector(
          Option.when(!decided)(
            s"$vehicle: nothing was decided on a new reading within " +
              s"${FaultPlan.ResumesWithin.toSeconds} s of calm"
          ),
          Option.when(
            !moments.exists(_ < due)
          )(s"$vehicle: no command came within ${FaultPlan.ResumesWithin.toSeconds} s of calm"),
          gaps.find(_ > LongestGap).map(gap =>
            s"$vehicle: no command for ${gap.toSeconds.fixed(2)} s in calm"
          )
        ).flatten

  private def isFresh(seen: FlightTrace, decision: DecisionRow, vehicle: String): Boolean =
    decision.vehicle == vehicle && decision.own.state.sentAt >= seen.calmFrom

  private def restless(seen: FlightTrace): Vector[String] =
    for (vehicle, drift) <- seen.vehicles.zip(seen.drifts) if drift.value > Hovering.value
    yield s"$vehicle flies on after the end: ${drift.value.fixed(1)} m in " +
      s"${FlightTrace.Watched.toSeconds.fixed(0)} s (${seen.outcome})"

  /** The simulator must run after a flight. A flight that ended during faults may have failed to resume it,
    * after several attempts.
    */
  private def standingStill(seen: FlightTrace): Vector[String] =
    Option
      .when(seen.leftPaused && seen.endedAt >= seen.calmFrom + FaultPlan.ResumesWithin)(
        s"the simulator was left standing still (${seen.outcome})"
      )
      .toVector

  /** However a flight ends, the last command to each vehicle must be to hover; without faults it must arrive.
    */
  private def notToldToHover(seen: FlightTrace): Vector[String] =
    val heeded = seen.endedAt >= seen.calmFrom + FaultPlan.ResumesWithin
    seen.vehicles.zip(seen.ports).flatMap: (vehicle, port) =>
      val lastMove = seen.arrivals.filter(_.vehicle == vehicle).map(_.at).maxOption
      val heard    = seen.lastHovers.get(vehicle)
      Vector(
        Option.when(!port.toldToHover)(s"$vehicle was not told to hover at the end (${seen.outcome})"),
        Option.when(heeded && lastMove.exists(at => !heard.exists(_ >= at)))(
          s"$vehicle: no command to hover came to the simulator after the last move (${seen.outcome})"
        )
      ).flatten

  /** The recorder must keep what was offered to it, and the file must contain it, row by row. */
  private def notInTheFile(seen: FlightTrace): Vector[String] =
    val offered                                  = Recording(seen.recording.heading, seen.offered)
    def missing(where: String, found: Recording) = Option.when(found != offered)(
      s"${Recorded.rows(offered)} rows were offered to the recorder, ${Recorded.rows(found)} are $where" +
        (if Recorded.rows(offered) == Recorded.rows(found) then ", and they differ" else "")
    )
    missing("on record", seen.recording).toVector ++ seen.file.flatMap:
      case Right(read) => missing("in the file", read)
      case Left(error) => Some(s"the file cannot be read: ${error.message}")

  private def ms(seen: FlightTrace, at: Instant): String = s"${at.since(seen.startedAt).toMillis.fixed(1)} ms"

  /** Additional requests after a missed answer. */
  private val SignsOfLife = 1

  private val ImagesOnTheWay = 2

  /** Maximum number of unanswered moves. After a connection was lost, its last moves may still be at the
    * simulator when those of the next one arrive.
    */
  private val MostUnanswered = 4

  /** Rows per second for each vehicle. As published, each decides at every reading of any vehicle, and drops
    * most of its decisions.
    */
  private val RowsPerSecond = 300.0

  private val LongestGap = Span.ofSeconds(1.5)

  /** Largest drift of a hovering vehicle. After a flight in circles the simulated vehicle, yawed by then,
    * circles around the held position, some 5 m away; the slowest move would carry it 18 m.
    */
  private val Hovering = Metres(14)

private object Recorded:
  def rows(recording: Recording): Int =
    Vector(
      recording.readings,
      recording.decisions,
      recording.commands,
      recording.acknowledgements,
      recording.events,
      recording.predictions,
      recording.sightings,
      recording.planned
    ).map(_.size).sum
