package skein.measure

/** How far the flights of one loop over one link, live or virtual, ended from the paused truth: what stands
  * for them ([[FlightSummary.headline]]) as a share of the truth's, less one, over the flights.
  *
  * @param name the loop's, with the policy where it is not the paper's
  * @param share 0.02 is 2 % further apart
  */
final case class Deviation(loop: String, name: String, link: String, clock: String, share: Distribution)

object Deviation:

  /** In the order of the flights, scenario by scenario; empty without a paused flight. A flight is held
    * against the truth of the same policies, and of its own clock where there is one. Without the truth
    * itself, and without those that a truth of 0 says nothing about.
    */
  def of(flights: Seq[FlightSummary]): Vector[Deviation] =
    flights.toVector.map(_.scenario).distinct.flatMap(scenario =>
      ofOne(flights.filter(_.scenario == scenario))
    )

  private def ofOne(flights: Seq[FlightSummary]): Vector[Deviation] =
    val flown                           = flights.toVector.filter(one => one.headline.isDefined)
    val truths                          = flown.filter(_.flight.isPaused)
    def key(one: FlightSummary)         = (one.name, one.flight.link, one.flight.clock)
    def mean(of: Vector[FlightSummary]) = Distribution.of(of.flatMap(_.headline)).map(_.mean)
    def truthFor(policy: Option[String], clock: String): Option[Double] =
      val same = truths.filter(_.policy == policy)
      mean(same.filter(_.flight.clock == clock)).orElse(mean(same))
    val others = flown.filterNot(_.flight.isPaused)
    for
      same <- others.map(key).distinct
      group = others.filter(key(_) == same)
      first = group.head
      truth <- truthFor(first.policy, first.flight.clock) if truth != 0
      share <- Distribution.of(group.flatMap(_.headline).map(_ / truth - 1))
    yield Deviation(first.flight.loop, first.name, first.flight.link, first.flight.clock, share)
