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
    TextTable.of(flights.map(summary => (summary.name, summary.flight.link)).distinct.map(groups))(
      "<loop"       -> (_.head.name),
      "<link"       -> (_.head.flight.link),
      "flights"     -> (group => mean(group).fold(group.size)(_.count).toString),
      "last 10 s m" -> metres(mean, _.mean),
      "sd"          -> metres(mean(_).filter(_.count > 1), _.sampleSd),
      "least"       -> metres(mean, _.least),
      "most"        -> metres(mean, _.most),
      "sd within"   -> metres(over(_, _.lastTenSeconds.map(_.sd)), _.mean),
      "closest m"   -> metres(closest, _.mean),
      "captured"    -> (closest(_).fold("")(_.sorted.count(_ < PlanTable.CaptureM).toString)),
      "vs paused"   -> (group =>
        Distribution.of(group.flatMap(truths.deviation)).fold("")(share =>
          s"${(100 * share.mean).signed(1)} %"
        )
      )
    )

  private def metres(of: Seq[FlightSummary] => Option[Distribution], value: Distribution => Double)(
      group: Seq[FlightSummary]
  ) = of(group).fold("")(distances => value(distances).fixed(2))

  private def mean(group: Seq[FlightSummary]) = over(group, _.lastTenSeconds.map(_.mean))

  private def closest(group: Seq[FlightSummary]) = over(group, curve => Some(curve.closest._2))

  private def over(group: Seq[FlightSummary], of: DistanceCurve => Option[Double]): Option[Distribution] =
    Distribution.of(group.flatMap(_.distance).flatMap(of))
