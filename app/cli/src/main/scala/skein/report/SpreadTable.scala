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
    val order  = flights.map(summary => (summary.name, summary.flight.link)).distinct
    TextTable(
      Vector(
        "<loop",
        "<link",
        "flights",
        "last 10 s m",
        "sd",
        "least",
        "most",
        "sd within",
        "closest m",
        "captured",
        "vs paused"
      ),
      order.toVector.map: group =>
        val mean    = meanDistance(groups(group))
        val within  = distribution(groups(group), _.lastTenSeconds.map(_.sd))
        val closest = distribution(groups(group), curve => Some(curve.closest._2))

        def metres(of: Option[Distribution], value: Distribution => Double) =
          of.fold("")(distances => value(distances).fixed(2))
        Vector(
          group._1,
          group._2,
          mean.fold(groups(group).size)(_.count).toString,
          metres(mean, _.mean),
          metres(mean.filter(_.count > 1), _.sampleSd),
          metres(mean, _.least),
          metres(mean, _.most),
          metres(within, _.mean),
          metres(closest, _.mean),
          closest.fold("")(_.sorted.count(_ < PlanTable.CaptureM).toString),
          Distribution.of(groups(group).flatMap(truths.deviation))
            .fold("")(share => s"${(100 * share.mean).signed(1)} %")
        )
    )

  private def meanDistance(flights: Seq[FlightSummary]) = distribution(flights, _.lastTenSeconds.map(_.mean))

  private def distribution(
      flights: Seq[FlightSummary],
      of: DistanceCurve => Option[Double]
  ): Option[Distribution] =
    Distribution.of(flights.flatMap(_.distance).flatMap(of))
