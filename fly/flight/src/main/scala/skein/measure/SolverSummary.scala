package skein.measure

import skein.record.{EventKind, EventSubject, Recording, SolvedRow}

/** What it came to that a flight's decisions were made in another process.
  *
  * @param at where the solver was
  * @param roundTripsMs from question to answer, of answers that were used: what the way there and back adds
  *   to the age of what is decided upon; absent where none was used
  * @param thinkingMs of these, what the solver took
  * @param missed decisions that had to be made without an answer
  * @param late answers that came too late
  * @param repeated messages that came more than once
  * @param left questions that the solver left for newer ones
  * @param lost how often the connection was lost
  * @param restarted decisions for which the solver remembered nothing of those before
  */
final case class SolverSummary(
    at: String,
    answers: Int,
    roundTripsMs: Option[Distribution],
    thinkingMs: Option[Distribution],
    missed: Int,
    late: Int,
    repeated: Int,
    left: Int,
    lost: Int,
    restarted: Int
)

object SolverSummary:

  /** Absent where the flight's own process decided. */
  def of(recording: Recording): Option[SolverSummary] =
    for at <- recording.heading.parameter(Parameter)
    yield
      val solved                      = recording.solved
      def ms(of: SolvedRow => Double) = Distribution.of(solved.map(of))
      def count(kind: EventKind)      = recording.events.count(_.kind == kind)
      def ofSolver(kind: EventKind)   =
        recording.events.filter(event => event.kind == kind && event.about.contains(EventSubject.Solver))
      SolverSummary(
        at,
        solved.size,
        ms(_.roundTrip.toMillis),
        ms(_.thinking.toMillis),
        count(EventKind.DeadlineMissed),
        ofSolver(EventKind.LateReply).size,
        count(EventKind.Repeated),
        ofSolver(EventKind.Dropped).flatMap(_.count).sum.toInt,
        ofSolver(EventKind.Disconnected).size,
        count(EventKind.SolverRestarted)
      )

  /** Under which a recording says where the solver was. */
  val Parameter = "solver"
