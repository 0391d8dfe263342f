package skein.report

import skein.measure.{Distribution, FlightSet, FlightSummary}
import skein.units.Decimals.{brief, fixed, signed}

/** The cost of decisions in another process, compared with the loop that decides in its own. */
object SolverTable:

  val title = "Decided elsewhere"

  def of(set: FlightSet): TextTable =
    TextTable(
      Vector("<loop", "<link", "<solver", "answers") ++
        Vector("added ms p50", "p99", "thinking", "age at command p50", "p99", "here", "p99") ++
        Vector("missed", "late", "twice", "left", "lost", "result", "here", "difference"),
      for
        summary <- set.flights
        solver  <- summary.solver.toVector
      yield
        val here = beside(set, summary)
        Vector(summary.flight.loop, summary.flight.link, solver.at, solver.answers.toString) ++
          spread(solver.roundTripsMs) ++
          Vector(solver.thinkingMs.fold("")(ms => ms.median.brief)) ++
          spread(summary.commandAgesMs) ++ spread(here.flatMap(_.commandAgesMs)) ++
          Vector(solver.missed, solver.late, solver.repeated, solver.left, solver.lost).map(_.toString) ++
          Vector(
            summary.headline.fold("")(_.fixed(2)),
            here.flatMap(_.headline).fold("")(_.fixed(2)),
            difference(summary, here)
          )
    )

  private def spread(ms: Option[Distribution]): Vector[String] =
    ms.fold(Vector("", ""))(all => Vector(all.median.fixed(1), all.p99.fixed(1)))

  /** The flight to compare with: a comparable one that decides in its own process, equal in everything else.
    */
  private def beside(set: FlightSet, flight: FlightSummary): Option[FlightSummary] =
    def like(one: FlightSummary) =
      import one.flight.{clock, duration, link, loop, period}
      (loop, link, clock, period, duration, one.policy, one.scenario, one.predictor, one.movesInFlight)
    set.all.find(other => other.solver.isEmpty && other.isComparable && like(other) == like(flight))

  private def difference(flight: FlightSummary, here: Option[FlightSummary]): String =
    flight.headline
      .zip(here.flatMap(_.headline))
      .filter(_._2 != 0)
      .fold("")((there, own) => s"${((there / own - 1) * 100).signed(1)} %")

  val note: String =
    "Here: the same loop, decided in the flight's own process. Added: ms from question to answer, for " +
      "answers that were used. Thinking: the part of it for which the solver computed. Age at command: " +
      "ms from the sampling of the vehicle's own physics to the sending of the command. Missed: " +
      "decisions that the fallback had to make. Late: answers that came after their deadline and were " +
      "not used. Twice: messages that came more than once and count once. Left: questions that the " +
      "solver left for newer ones. Lost: connections. Result: the scenario's first measure, such as the " +
      "distance over the last 10 s."
