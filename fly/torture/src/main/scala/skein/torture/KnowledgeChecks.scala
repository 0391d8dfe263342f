package skein.torture

import skein.loop.LoopKind
import skein.record.{DecisionRow, ReadingRow}
import skein.signal.Stamped
import skein.units.*
import skein.units.Decimals.fixed

/** Judges what decisions were made from: whether it was the newest that the vehicles had told, and as old as
  * was said.
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

  /** What is on record of a vehicle is what it told, under the number of its question. */
  private def misquoted(seen: FlightTrace, told: Map[String, Vector[ReportedState]]): Vector[String] =
    val states = told.map((vehicle, answers) => vehicle -> answers.map(a => a.question -> a.state).toMap)
    seen.recording.readings
      .find(reading => !states(reading.vehicle).get(reading.sequence).contains(reading.state))
      .map(reading => s"${reading.vehicle}: reading ${reading.sequence} is not what the vehicle answered")
      .toVector

  /** No answer that the controller had is newer than the one decided upon, but for those that came within the
    * time that a loop may take to join what belongs together.
    */
  private def outdated(seen: FlightTrace, told: Map[String, Vector[ReportedState]]): Vector[String] =
    val joins = seen.faultPlan.loop match
      case LoopKind.Sequential => Span.Zero
      case LoopKind.Stream     => seen.patience
      case _                   => seen.period
    val histories = told.map((vehicle, answers) => vehicle -> History(answers))
    firstOf(seen): (decision, used) =>
      histories(used.vehicle)
        .newerThan(used, (decision.decidedAt - joins).max(used.state.receivedAt), isNewer(seen.runs))
        .map: newer =>
          s"used reading ${used.sequence} of ${used.vehicle} and had the newer ${newer.question} since " +
            s"${decision.decidedAt.since(newer.state.receivedAt).toMillis.fixed(1)} ms"

  /** Nobody decides upon something older than what it has decided upon before. */
  private def backwards(seen: FlightTrace): Vector[String] =
    val newest = scala.collection.mutable.Map.empty[(String, String), ReadingRow]
    firstOf(seen): (decision, used) =>
      val before = newest.put((decision.vehicle, used.vehicle), used)
      before
        .filter(reading => isNewer(seen.runs)(reading.state, used.state))
        .map(reading =>
          s"used reading ${used.sequence} of ${used.vehicle} after the newer ${reading.sequence}"
        )

  /** What is read together is decided upon when the last of it comes. */
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

  /** Whether the simulator was started again since the step before was read: the readings of this one are of
    * two clocks, or of a simulator that ran while they were asked for.
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

  /** By how much the controller's clock was truly ahead of the simulator's. None while it cannot be known
    * yet: all that a run before the simulator's present one has told must have gone by; and never, where the
    * clock of a new run is so near to the one before that no answer shows the difference.
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

  /** Whether one state was truly sampled after another, said without the loop's own word for it. Where the
    * simulator was started again between them with nearly the same clock, only if what they tell shows it.
    */
  private[torture] def isNewer(runs: Vector[Run])(one: Stamped[?], other: Stamped[?]): Boolean =
    val offsets                               = clockOffset(runs, one).zip(clockOffset(runs, other))
    def follows(a: Stamped[?], b: Stamped[?]) = a.validAt > b.validAt || a.sentAt > b.receivedAt
    val isShown = offsets.exists((mine, its) => (mine - its).max(its - mine) >= Noticed) ||
      (follows(one, other) && !follows(other, one))
    isShown && offsets.forall((mine, its) => one.validAt + mine > other.validAt + its)

  /** Of the run of the simulator whose answer can have come from within the question's time. */
  private def clockOffset(runs: Vector[Run], state: Stamped[?]): Option[Span] =
    runs.map(_.clockOffset).find: offset =>
      val at = state.validAt + offset
      at >= state.sentAt && at <= state.receivedAt

  /** What one vehicle told, in the order in which it came. */
  private final class History(answers: Vector[ReportedState]):
    private val arrivals = answers.map(_.state.receivedAt)

    /** The first that came before `until`, and is newer than a reading. What is newer by much came lately:
      * only the last [[Recent]] are looked at.
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

  /** Answers of one vehicle within some 6 s. */
  private val Recent = 64

  /** An answer that took longer has timed out, and what it belonged to is joined without it. */
  private val Gone = Span.ofMillis(700)

  /** A jump of the clock beyond the longest round trip contradicts what was known before. */
  private val Noticed = Span.ofSeconds(1)
