package skein.report

import skein.record.{Planned, Recording}

/** How a flight's decisions were planned.
  *
  * @param candidates
  *   per plan
  * @param slices
  *   of all vehicles that were planned for together
  * @param tookMs
  *   from asking until the decision was there
  * @param missed
  *   deadlines at which nothing was ready
  * @param breached
  *   plans that could not keep within a hard limit
  */
final case class PlanningSummary(
    candidates: Distribution,
    slices: Distribution,
    tookMs: Distribution,
    missed: Int,
    breached: Int
)

object PlanningSummary:

  /** Absent where nothing was planned. */
  def of(recording: Recording): Option[PlanningSummary] =
    val plans = recording.planned
    for
      candidates <- Distribution.of(plans.map(_.candidates.toDouble))
      slices     <- Distribution.of(plans.map(slicesOf(_).toDouble))
      tookMs     <- Distribution.of(plans.map(_.took.toMillis))
    yield PlanningSummary(
      candidates,
      slices,
      tookMs,
      plans.count(_.candidates == 0),
      plans.count(_.breaches > 0)
    )

  private def slicesOf(planned: Planned): Int = planned.slices.split(',').flatMap(_.toIntOption).sum

/** How plans were made, and what came of them. */
object PlanTable:

  /** Below this distance an evader is captured, m. */
  val CaptureM = 1.5

  /** A row per flight that planned; in what a pursuer caught, where duels were flown. */
  def of(set: FlightSet): TextTable =
    val duels = hasDuels(set)
    TextTable(
      Vector("<loop", "<link", "plans", "candidates per tick", "least", "slices", "ms", "p99") ++
        Vector("deadlines missed", "limits broken") ++
        (if duels then Vector("captured at s", "below 1.5 m") else Vector.empty),
      for
        summary  <- set.flights
        planning <- summary.planning.toVector
      yield Vector(
        summary.flight.loop,
        summary.flight.link,
        planning.candidates.count.toString,
        SummaryTables.fixed(planning.candidates.mean, 0),
        SummaryTables.fixed(planning.candidates.least, 0),
        SummaryTables.fixed(planning.slices.mean, 1),
        SummaryTables.brief(planning.tookMs.mean),
        SummaryTables.brief(planning.tookMs.p99),
        planning.missed.toString,
        planning.breached.toString
      ) ++ (if duels then summary.distance.fold(Vector("", ""))(caught) else Vector.empty)
    )

  private def caught(distance: DistanceCurve): Vector[String] =
    val below = distance.points.filter(_._2 < CaptureM)
    Vector(
      below.headOption.fold("never")(first => SummaryTables.fixed(first._1, 1)),
      s"${SummaryTables.fixed(100.0 * below.size / distance.points.size, 1)} %"
    )

  private def hasDuels(set: FlightSet): Boolean =
    set.flights.exists(summary => summary.planning.nonEmpty && summary.distance.nonEmpty)

  val title = "Plans"

  /** How to read it. */
  def note(set: FlightSet): String =
    "Candidate manoeuvres flown forward per vehicle and tick, all searches together; slices are of all vehicles planned for together; ms from the tick to the decision; a deadline is " +
      "missed where no slice was ready, and the last plan went on or the policy decided" +
      (if hasDuels(set) then
         "; captured where the distance first is below 1.5 m, and the share of the flight below it"
       else "")
