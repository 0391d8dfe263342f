package skein.report

import skein.measure.{DistanceCurve, Distribution, FlightSummary, Truth}
import skein.units.Decimals.{fixed, signed}

/** The variation of a loop's result from flight to flight. */
object SpreadTable:

  /** A row per loop and link, in the order of the flights: over its flights, mean and standard deviation of
    * the mean distance in the last 10 s, and of the standard deviation within a flight's last 10 s, the
    * closest approach, in how many flights it was a capture, and the mean deviation from the [[Truth]]. Where
    * a loop and link gave no distance, since a vehicle was never read, the flights are only counted.
    */
  def of(flights: Seq[FlightSummary]): TextTable =
    val truths = Truth.among(flights)
    val groups = flights.groupBy(summary => (summary.name, summary.flight.link))
    val rows   = flights.map(summary => (summary.name, summary.flight.link)).distinct.map(groups).map(Row(_))
    TextTable.of(rows)(
      "<loop"       -> (_.flights.head.name),
      "<link"       -> (_.flights.head.flight.link),
      "flights"     -> (row => row.mean.fold(row.flights.size)(_.count).toString),
      "last 10 s m" -> (row => metres(row.mean)(_.mean)),
      "sd"          -> (row => metres(row.mean.filter(_.count > 1))(_.sampleSd)),
      "least"       -> (row => metres(row.mean)(_.least)),
      "most"        -> (row => metres(row.mean)(_.most)),
      "sd within"   -> (row => metres(row.within)(_.mean)),
      "closest m"   -> (row => metres(row.closest)(_.mean)),
      "captured"    -> (_.closest.fold("")(_.sorted.count(_ < PlanTable.CaptureM).toString)),
      "vs paused"   -> (row =>
        Distribution.of(row.flights.flatMap(truths.deviation)).fold("")(share =>
          s"${(100 * share.mean).signed(1)} %"
        )
      )
    )

  private final class Row(val flights: Seq[FlightSummary]):
    val mean: Option[Distribution]    = over(_.lastTenSeconds.map(_.mean))
    val within: Option[Distribution]  = over(_.lastTenSeconds.map(_.sd))
    val closest: Option[Distribution] = over(curve => Some(curve.closest._2))

    private def over(of: DistanceCurve => Option[Double]): Option[Distribution] =
      Distribution.of(flights.flatMap(_.distance).flatMap(of))

  private def metres(of: Option[Distribution])(value: Distribution => Double): String =
    of.fold("")(distances => value(distances).fixed(2))
