package skein.measure

import skein.record.{EventKind, EventSubject, Recording, SolvedRow}

/** Statistics of a flight whose decisions were made in another process.
  *
  * @param at the solver's address
  * @param roundTripsMs times from request to answer, of used answers: the transport's part of the decisions'
  *   data age; absent if none was used
  * @param thinkingMs the solver's time for these
  * @param missed number of decisions made without an answer
  * @param late number of answers after their deadline
  * @param repeated number of messages received more than once
  * @param left number of requests that the solver skipped for newer ones
  * @param lost number of times the connection was lost
  * @param restarted number of decisions for which the solver had no memory of those before
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

  /** Absent if the flight's own process decided. */
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

  /** The parameter of a recording that holds the solver's address. */
  val Parameter = "solver"
