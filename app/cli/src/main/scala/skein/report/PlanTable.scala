package skein.report

import skein.measure.{DistanceCurve, FlightSet}
import skein.units.Decimals.{brief, fixed}

/** The effort of planning and the plans' results, as a table. */
object PlanTable:

  /** Distance below which an evader is captured, m. */
  val CaptureM = 1.5

  /** A row per flight with planning; with the pursuer's captures, in duels. */
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
        planning.candidates.mean.fixed(0),
        planning.candidates.least.fixed(0),
        planning.slices.mean.fixed(1),
        planning.tookMs.mean.brief,
        planning.tookMs.p99.brief,
        planning.missed.toString,
        planning.breached.toString
      ) ++ (if duels then summary.distance.fold(Vector("", ""))(caught) else Vector.empty)
    )

  private def caught(distance: DistanceCurve): Vector[String] =
    val below = distance.points.filter(_._2 < CaptureM)
    Vector(
      below.headOption.fold("never")(first => first._1.fixed(1)),
      s"${(100.0 * below.size / distance.points.size).fixed(1)} %"
    )

  private def hasDuels(set: FlightSet): Boolean =
    set.flights.exists(summary => summary.planning.nonEmpty && summary.distance.nonEmpty)

  val title = "Plans"

  def note(set: FlightSet): String =
    "Candidates: manoeuvres simulated per vehicle and tick, in all searches together. Slices: steps in " +
      "which searches improved the plans of all vehicles together. ms: from the tick to the decision. " +
      "A deadline is missed where no slice was ready; then the last plan went on, or the policy decided" +
      (if hasDuels(set) then
         ". Captured: when the distance first was below 1.5 m, and the share of the flight below it"
       else "")
