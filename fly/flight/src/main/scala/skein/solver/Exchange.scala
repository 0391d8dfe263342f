package skein.solver

import skein.signal.{ClockAlignment, Stamped}
import skein.units.*

/** The flight's side of its requests: decides which answer counts. Immutable. Vehicles with joint decisions
  * count as the first of them.
  *
  * An answer counts if it is to the newest request for its vehicle, is received before that one's deadline,
  * and for the first time. So nothing overtakes: a delayed answer is not used after a newer request.
  *
  * @param solver the last known start of the solver
  * @param clocks relation of the solver's clock to the controller's
  * @param trips the latest round trips of answers that counted, without the time meant for searching, the
  *   newest last
  * @param told the last counts reported by that start of the solver
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

  /** The estimated offset of the solver's clock. */
  def solverClock: Option[(solver: Long, offset: Span)] =
    solver.zip(clocks).map((solver, known) => (solver = solver, offset = known.offset))

  /** Expected time from a request to its answer: the recent mean; zero before the first. */
  def delay: Span = if trips.isEmpty then Span.Zero else trips.reduce(_ + _) / trips.size.toLong

  /** Adds a request.
    *
    * @param searching time that the solver has for its search
    * @return also the request's number
    */
  def asked(vehicle: Int, at: Instant, until: Instant, searching: Span = Span.Zero): (Exchange, Long) =
    val (next, number) = vehicles(vehicle).asked(at, until, searching)
    (copy(vehicles = vehicles.updated(vehicle, next), counts = counts.copy(asked = counts.asked + 1)), number)

  /** Classifies an answer.
    *
    * @param at time of receipt
    */
  def heard(answer: Answer, at: Instant): (Exchange, Verdict) =
    val known = vehicles.lift(answer.vehicle).getOrElse(Vehicle.silent)
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

  /** The counts that the solver reports in excess of its last report; to be called after [[heard]]. */
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

  /** Aligns the clocks. A restarted solver has a new clock, and its counts start at zero. */
  private def aligned(answer: Answer, asked: Instant, at: Instant): Exchange =
    val thinking = answer.answeredAt.since(answer.takenAt).max(Span.Zero)
    // As if the solver had taken no time: then both directions bound the offset.
    val seen = Stamped((), answer.takenAt, asked, at - thinking)
    if solver.contains(answer.solver) then
      copy(clocks = Some(clocks.fold(ClockAlignment.of(seen))(_.updated(seen))))
    else copy(solver = Some(answer.solver), clocks = Some(ClockAlignment.of(seen)), told = Told(0, 0))

object Exchange:
  /** Number of round trips behind the expected delay: of some seconds. */
  val Remembered = 32

  /** Maximum number of a vehicle's requests whose answers can still be classified as late or repeated. */
  val MostOpen = 64

  def of(vehicles: Int): Exchange =
    Exchange(Vector.fill(vehicles)(Vehicle.silent), None, None, Vector.empty, Told(0, 0), Counts())

  /** The classification of a received answer. */
  enum Verdict:
    /** The answer counts as the decision. */
    case Counts(askedAt: Instant)

    /** It was received after its deadline, or after a newer request. */
    case Late(after: Span)

    /** It was received before: a repetition. */
    case Repeated

    /** It answers no known request. */
    case Foreign

  /** The solver's counts.
    *
    * @param overtaken number of requests that the solver skipped for newer ones
    * @param repeated number of requests that it received more than once
    */
  final case class Told(overtaken: Long, repeated: Long)

  /** Counts of a flight's requests and answers.
    *
    * @param used number of answers that counted
    * @param repeated number of answers received more than once
    * @param foreign number of answers to no known request
    * @param overtaken number of requests that the solver skipped for newer ones
    * @param repeatedThere number of requests that the solver received more than once
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

  /** One vehicle's requests.
    *
    * @param next number of the next request
    * @param open the newest requests without an answer, keyed by number: time of request, deadline, and the
    *   part of that time for searching
    */
  final case class Vehicle(next: Long, open: Map[Long, (asked: Instant, until: Instant, searching: Span)]):
    private[Exchange] def asked(at: Instant, until: Instant, searching: Span): (Vehicle, Long) =
      val kept = open.filter((number, _) => number > next - MostOpen)
      (Vehicle(next + 1, kept.updated(next, (asked = at, until = until, searching = searching))), next)

  object Vehicle:
    val silent: Vehicle = Vehicle(0, Map.empty)
