package skein.solver

import skein.signal.{ClockAlignment, Stamped}
import skein.units.*

/** A flight's side of its questions: which answer counts. Immutable. Vehicles that are decided for together
  * count as the first of them.
  *
  * An answer counts if it is to the newest question for its vehicle, comes before that one's deadline, and
  * comes for the first time. So nothing overtakes: an answer that was held up is not used once something
  * newer was asked.
  *
  * @param solver the start of the solver that was heard of last
  * @param clocks how its clock stands to the controller's
  * @param trips the latest round trips of answers that counted, without what was meant for searching, the
  *   newest last
  * @param told what that start of the solver has counted, as told last
  */
final case class Exchange private (
    vehicles: Vector[Exchange.Vehicle],
    solver: Option[Long],
    clocks: Option[ClockAlignment],
    trips: Vector[Span],
    told: Exchange.Told,
    counts: Exchange.Counts
):
  import Exchange.*

  /** How the solver's clock is known to stand. */
  def solverClock: Option[(solver: Long, offset: Span)] =
    solver.zip(clocks).map((solver, known) => (solver = solver, offset = known.offset))

  /** Expected from a question to its answer: the mean of late; zero before the first. */
  def delay: Span = if trips.isEmpty then Span.Zero else trips.reduce(_ + _) / trips.size.toLong

  /** @param searching for how long the solver is to look for its answer
    * @return with the question's number
    */
  def asked(vehicle: Int, at: Instant, until: Instant, searching: Span = Span.Zero): (Exchange, Long) =
    val (next, number) = vehicles(vehicle).asked(at, until, searching)
    (copy(vehicles = vehicles.updated(vehicle, next), counts = counts.copy(asked = counts.asked + 1)), number)

  /** @param at when the answer came
    */
  def heard(answer: Answer, at: Instant): (Exchange, Verdict) =
    val known = if answer.vehicle < vehicles.size then vehicles(answer.vehicle) else Vehicle.silent
    known.open.get(answer.number) match
      case None if answer.number < known.next =>
        (copy(counts = counts.copy(repeated = counts.repeated + 1)), Verdict.Repeated)
      case None => (copy(counts = counts.copy(foreign = counts.foreign + 1)), Verdict.Foreign)
      case Some((asked, until, searching)) =>
        val isTimely = answer.number == known.next - 1 && at < until
        val settled  = known.copy(open = known.open - answer.number)
        val heard    = copy(vehicles = vehicles.updated(answer.vehicle, settled)).aligned(answer, asked, at)
        if isTimely then
          val trip   = (at.since(asked) - searching).max(Span.Zero)
          val lately = (trips :+ trip).takeRight(Remembered)
          (heard.copy(trips = lately, counts = counts.copy(used = counts.used + 1)), Verdict.Counts(asked))
        else (heard.copy(counts = counts.copy(late = counts.late + 1)), Verdict.Late(at.since(asked)))

  /** What the solver says more than before that it did not decide; asked when the answer was heard. */
  def news(answer: Answer): (Exchange, Told) =
    if !solver.contains(answer.solver) then (this, Told(0, 0))
    else
      val now  = Told(answer.overtaken.max(told.overtaken), answer.repeated.max(told.repeated))
      val more = Told(now.overtaken - told.overtaken, now.repeated - told.repeated)
      val all  = counts.copy(
        overtaken = counts.overtaken + more.overtaken,
        repeatedThere = counts.repeatedThere + more.repeated
      )
      (copy(told = now, counts = all), more)

  /** Another start of a solver has another clock, and counts anew. */
  private def aligned(answer: Answer, asked: Instant, at: Instant): Exchange =
    val thinking = answer.answeredAt.since(answer.takenAt).max(Span.Zero)
    // As if it had taken no time: then both ways bound the offset.
    val seen = Stamped((), answer.takenAt, asked, at - thinking)
    if solver.contains(answer.solver) then
      copy(clocks = Some(clocks.fold(ClockAlignment.of(seen))(_.updated(seen))))
    else copy(solver = Some(answer.solver), clocks = Some(ClockAlignment.of(seen)), told = Told(0, 0))

object Exchange:
  /** Round trips that the expected delay is made from: of some seconds. */
  val Remembered = 32

  /** Questions of a vehicle whose answers are still told late from repeated. */
  val MostOpen = 64

  def of(vehicles: Int): Exchange =
    Exchange(Vector.fill(vehicles)(Vehicle.silent), None, None, Vector.empty, Told(0, 0), Counts())

  /** What became of an answer. */
  enum Verdict:
    /** It is what is decided. */
    case Counts(askedAt: Instant)

    /** It came after its deadline, or after something newer was asked. */
    case Late(after: Span)

    /** It has come before. */
    case Repeated

    /** Nobody asked that. */
    case Foreign

  /** @param overtaken questions that the solver left for newer ones
    * @param repeated questions that came there more than once
    */
  final case class Told(overtaken: Long, repeated: Long)

  /** How often what has happened.
    *
    * @param used answers that counted
    * @param repeated answers that came more than once
    * @param foreign answers to nothing that was asked
    * @param overtaken questions that the solver left for newer ones
    * @param repeatedThere questions that came to the solver more than once
    */
  final case class Counts(
      asked: Long = 0,
      used: Long = 0,
      late: Long = 0,
      repeated: Long = 0,
      foreign: Long = 0,
      overtaken: Long = 0,
      repeatedThere: Long = 0
  )

  /** @param next number of the next question
    * @param open those without an answer, the newest of them: when they were asked, until when an answer
    *   counts, and how much of that is for searching
    */
  final case class Vehicle(next: Long, open: Map[Long, (asked: Instant, until: Instant, searching: Span)]):
    private[Exchange] def asked(at: Instant, until: Instant, searching: Span): (Vehicle, Long) =
      val kept = open.filter((number, _) => number > next - MostOpen)
      (Vehicle(next + 1, kept.updated(next, (asked = at, until = until, searching = searching))), next)

  object Vehicle:
    val silent: Vehicle = Vehicle(0, Map.empty)
