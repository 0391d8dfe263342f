package skein.report

/** How much a loop's result varies from flight to flight. */
object SpreadTable:

  /** A row per loop and link, in the order of the flights: over its flights, mean and standard deviation of the mean
    * distance in the last 10 s, the same of the standard deviation within a flight's last 10 s, the closest approach,
    * in how many flights it was a capture, and the deviation from the paused truth of the same policies where it was
    * flown too.
    */
  def of(flights: Seq[FlightSummary]): TextTable =
    val groups = flights.groupBy(summary => (summary.name, summary.flight.link))
    val order  = flights.map(summary => (summary.name, summary.flight.link)).distinct
    val truths =
      flights.filter(_.flight.loop == "paused").groupBy(_.policy).view.mapValues(meanDistance(_).mean)
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
        val within  = distribution(groups(group), _.lastTenSeconds.sd)
        val closest = distribution(groups(group), _.closest._2)
        Vector(
          group._1,
          group._2,
          mean.count.toString,
          SummaryTables.fixed(mean.mean, 2),
          SummaryTables.fixed(mean.sd, 2),
          SummaryTables.fixed(mean.least, 2),
          SummaryTables.fixed(mean.most, 2),
          SummaryTables.fixed(within.mean, 2),
          SummaryTables.fixed(closest.mean, 2),
          closest.sorted.count(_ < PlanTable.CaptureM).toString,
          truths.get(groups(group).head.policy).fold("")(truth =>
            String.format(java.util.Locale.ROOT, "%+.1f %%", 100 * (mean.mean / truth - 1))
          )
        )
    )

  private def meanDistance(flights: Seq[FlightSummary]) = distribution(flights, _.lastTenSeconds.mean)

  private def distribution(flights: Seq[FlightSummary], of: DistanceCurve => Double): Distribution =
    Distribution
      .of(flights.flatMap(_.distance).map(of))
      .getOrElse(throw IllegalArgumentException(
        "these flights have no distance between a pursuer and an evader"
      ))
