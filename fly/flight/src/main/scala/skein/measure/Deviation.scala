package skein.measure

/** The deviation of the flights of one loop over one link in one scenario, live or virtual, from the paused
  * flight: their headline measure ([[FlightSummary.headline]]) as a fraction of the paused flight's, minus
  * one, over the flights.
  *
  * @param name the loop's name, with the policy unless it is the paper's policy
  * @param share 0.02 means 2 % more
  * @param scenario empty if all flights that are shown are of one
  */
final case class Deviation(
    loop: String,
    name: String,
    link: String,
    clock: String,
    share: Distribution,
    scenario: String = ""
)

object Deviation:

  /** The deviations in the order of the flights, scenario by scenario: each against its [[Truth]]. Empty
    * without a paused flight.
    */
  def of(flights: Seq[FlightSummary]): Vector[Deviation] =
    def key(one: FlightSummary) = (one.scenario, one.name, one.flight.link, one.flight.clock)
    val keys                    = flights.map(_.scenario).distinct.zipWithIndex.toMap
    val scenarioOf              = ScenarioNames.among(flights)
    val truths                  = Truth.among(flights)
    val off                     = flights.toVector.flatMap(one => truths.deviation(one).map(one -> _))
    off.map((one, _) => key(one)).distinct.sortBy((scenario, _, _, _) => keys(scenario)).flatMap: same =>
      val group = off.filter((one, _) => key(one) == same)
      val first = group.head._1
      Distribution.of(group.map(_._2)).map: share =>
        import first.flight.{clock, link, loop}
        Deviation(loop, first.name, link, clock, share, scenarioOf(first))
