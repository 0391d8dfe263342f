package skein.torture

import skein.loop.LoopKind
import skein.record.{DecisionRow, ReadingRow}
import skein.signal.Stamped
import skein.units.*
import skein.units.Decimals.fixed

/** Checks the inputs of decisions: they must be the newest data that the vehicles reported, with correct
  * ages.
  */
private[torture] object KnowledgeChecks:

  def violations(seen: FlightTrace): Vector[String] =
    val told = seen.vehicles.zip(seen.ports.map(_.answers)).toMap
    Vector(
      misquoted(seen, told),
      seen.faultPlan.loop match
        case LoopKind.Paused                            => Vector.empty
        case LoopKind.Futures                           => notAtOnce(seen, told)
        case LoopKind.Sequential                        => notAtOnce(seen, told) ++ outdated(seen, told)
        case _ if seen.faultPlan.scenario.isAsPublished => backwards(seen)
        case _                                          => outdated(seen, told) ++ backwards(seen)
      ,
      agesWrong(seen)
    ).flatten

  /** Recorded states must equal the vehicle's reports, under the number of the request. */
  private def misquoted(seen: FlightTrace, told: Map[String, Vector[ReportedState]]): Vector[String] =
    val states = told.map((vehicle, answers) => vehicle -> answers.map(a => a.question -> a.state).toMap)
    seen.recording.readings
      .find(reading => !states(reading.vehicle).get(reading.sequence).contains(reading.state))
      .map(reading => s"${reading.vehicle}: reading ${reading.sequence} is not what the vehicle answered")
      .toVector

  /** A decision must use the newest answer received, except for those received within the time that a loop
    * may take to join readings.
    */
  private def outdated(seen: FlightTrace, told: Map[String, Vector[ReportedState]]): Vector[String] =
    val joins = seen.faultPlan.loop match
      case LoopKind.Sequential => Span.Zero
      case LoopKind.Stream     => seen.settings.patience
      case _                   => seen.settings.period
    val histories = told.map((vehicle, answers) => vehicle -> History(answers))
    firstOf(seen): (decision, used) =>
      histories(used.vehicle)
        .newerThan(used, (decision.decidedAt - joins).max(used.state.receivedAt), isNewer(seen.runs))
        .map: newer =>
          s"used reading ${used.sequence} of ${used.vehicle} and had the newer ${newer.question} since " +
            s"${decision.decidedAt.since(newer.state.receivedAt).toMillis.fixed(1)} ms"

  /** A decision must not use older data than an earlier one. */
  private def backwards(seen: FlightTrace): Vector[String] =
    val newest = scala.collection.mutable.Map.empty[(String, String), ReadingRow]
    firstOf(seen): (decision, used) =>
      val before = newest.put((decision.vehicle, used.vehicle), used)
      before
        .filter(reading => isNewer(seen.runs)(reading.state, used.state))
        .map(reading =>
          s"used reading ${used.sequence} of ${used.vehicle} after the newer ${reading.sequence}"
        )

  /** A decision on a group of readings must be made when the last of them is received. */
  private def notAtOnce(seen: FlightTrace, told: Map[String, Vector[ReportedState]]): Vector[String] =
    val moments = told(seen.vehicles.last).map(_.state.receivedAt).toSet
    seen.recording.decisions
      .find(decision => !moments(decision.decidedAt))
      .map(decision => s"${where(decision)} was made when no round of readings had come")
      .toVector

  private def agesWrong(seen: FlightTrace): Vector[String] =
    val wrong = seen.recording.decisions.iterator.flatMap: decision =>
      val now                          = decision.decidedAt
      def arrived(reading: ReadingRow) =
        if seen.faultPlan.loop != LoopKind.Paused then now.since(reading.state.receivedAt)
        else if ranWhileRead(seen, decision) then now.since(reading.state.validAt)
        else Span.Zero
      val observed  = decision.observations
      val byArrival = Seq(
        ("its own data", observed.ownAge, arrived(decision.own)),
        ("its opponent's data", observed.opponentAge, arrived(decision.opponent))
      ).collect:
        case (whose, told, since) if told != since =>
          s"${where(decision)}: $whose had come ${since.toMillis.fixed(3)} " +
            s"ms before, told were ${told.toMillis.fixed(3)} ms"
      byArrival ++ trueAgesWrong(seen, decision)
    wrong.nextOption().toVector

  /** Whether the simulator was restarted since the previous step was read: this step's readings are of two
    * clocks, or of a simulator that ran while they were requested.
    */
  private def ranWhileRead(seen: FlightTrace, decision: DecisionRow): Boolean =
    val answers =
      for
        reading <- Seq(decision.own, decision.opponent)
        answer  <- seen.ports(seen.vehicles.indexOf(reading.vehicle)).answers
        if answer.question == reading.sequence || answer.question == reading.sequence - 1
      yield answer.state
    val (first, last) = (answers.map(_.sentAt).reduce(_.min(_)), answers.map(_.receivedAt).reduce(_.max(_)))
    seen.runs.exists(run => run.from >= first && run.from <= last)

  private def trueAgesWrong(seen: FlightTrace, decision: DecisionRow): Seq[String] =
    for
      told                  <- decision.trueAge.toSeq
      offset                <- trueOffset(seen, decision).toSeq
      (whose, age, reading) <- Seq(
        ("its own data", told.own, decision.own),
        ("its opponent's data", told.opponent, decision.opponent)
      )
      sampledAt = reading.state.validAt + offset
      old       = decision.decidedAt.since(sampledAt)
      off       = age - old
      if off > told.uncertainty || off < Span.Zero - told.uncertainty
    yield s"${where(decision)}: $whose was ${old.toMillis.fixed(3)} ms old, told were " +
      s"${age.toMillis.fixed(3)} ms to within ${told.uncertainty.toMillis.fixed(3)} ms"

  /** The true offset of the controller's clock from the simulator's. None while it cannot be known yet: until
    * all reports of earlier runs have passed; and never, if a new run's clock is so near to the previous one
    * that no answer shows the difference.
    */
  private def trueOffset(seen: FlightTrace, decision: DecisionRow): Option[Span] =
    if seen.faultPlan.loop == LoopKind.Paused then Some(Span.Zero)
    else
      val runs      = seen.runs
      val unnoticed = runs.zip(runs.drop(1)).exists: (one, next) =>
        val jump = next.clockOffset - one.clockOffset
        jump != Span.Zero && jump > Span.Zero - Noticed && jump < Noticed
      val present = runs.lastIndexWhere(_.from <= decision.decidedAt)
      if unnoticed || present < 0 then None
      else if present == 0 then Some(runs.head.clockOffset)
      else
        val asked   = runs(present).from + Gone
        val settled = seen.ports.forall(
          _.answers.exists(a => a.state.sentAt >= asked && a.state.receivedAt + Gone <= decision.decidedAt)
        )
        val used = Seq(decision.own, decision.opponent).forall(_.state.sentAt >= runs(present).from)
        Option.when(settled && used)(runs(present).clockOffset)

  private def firstOf(seen: FlightTrace)(wrong: (DecisionRow, ReadingRow) => Option[String]): Vector[String] =
    seen.recording.decisions.iterator
      .flatMap(decision =>
        Iterator(decision.own, decision.opponent).flatMap(used =>
          wrong(decision, used).map(what => s"${where(decision)} $what")
        )
      )
      .nextOption()
      .toVector

  private def where(decision: DecisionRow) = s"decision ${decision.sequence} of ${decision.vehicle}"

  /** Whether one state was truly sampled after another, determined independently of the loop. If the
    * simulator was restarted between them with a nearly equal clock, only if the reports show it.
    */
  private[torture] def isNewer(runs: Vector[Run])(one: Stamped[?], other: Stamped[?]): Boolean =
    val offsets                               = clockOffset(runs, one).zip(clockOffset(runs, other))
    def follows(a: Stamped[?], b: Stamped[?]) = a.validAt > b.validAt || a.sentAt > b.receivedAt
    val isShown = offsets.exists((mine, its) => (mine - its).max(its - mine) >= Noticed) ||
      (follows(one, other) && !follows(other, one))
    isShown && offsets.forall((mine, its) => one.validAt + mine > other.validAt + its)

  /** Clock offset of the run of the simulator whose answer can have been sampled within the request's time.
    */
  private def clockOffset(runs: Vector[Run], state: Stamped[?]): Option[Span] =
    runs.map(_.clockOffset).find: offset =>
      val at = state.validAt + offset
      at >= state.sentAt && at <= state.receivedAt

  /** The reports of one vehicle, in the order of receipt. */
  private final class History(answers: Vector[ReportedState]):
    private val arrivals = answers.map(_.state.receivedAt)

    /** The first report received before `until` that is newer than a reading. Only the last [[Recent]]
      * reports are searched, which include every much newer one.
      */
    def newerThan(
        used: ReadingRow,
        until: Instant,
        isNewer: (Stamped[?], Stamped[?]) => Boolean
    ): Option[ReportedState] =
      val come = arrivals.search(until).insertionPoint
      answers.slice(come - Recent, come).find(answer =>
        answer.state.receivedAt < until && isNewer(answer.state, used.state)
      )

  /** Number of a vehicle's answers in about 6 s. */
  private val Recent = 64

  /** Time after which an answer has timed out, and its view is joined without it. */
  private val Gone = Span.ofMillis(700)

  /** A clock jump longer than the longest round trip contradicts earlier readings. */
  private val Noticed = Span.ofSeconds(1)
