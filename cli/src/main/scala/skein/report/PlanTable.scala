package skein.report

import skein.measure.{DistanceCurve, FlightSet, Numbers}

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
        Numbers.fixed(planning.candidates.mean, 0),
        Numbers.fixed(planning.candidates.least, 0),
        Numbers.fixed(planning.slices.mean, 1),
        Numbers.brief(planning.tookMs.mean),
        Numbers.brief(planning.tookMs.p99),
        planning.missed.toString,
        planning.breached.toString
      ) ++ (if duels then summary.distance.fold(Vector("", ""))(caught) else Vector.empty)
    )

  private def caught(distance: DistanceCurve): Vector[String] =
    val below = distance.points.filter(_._2 < CaptureM)
    Vector(
      below.headOption.fold("never")(first => Numbers.fixed(first._1, 1)),
      s"${Numbers.fixed(100.0 * below.size / distance.points.size, 1)} %"
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
