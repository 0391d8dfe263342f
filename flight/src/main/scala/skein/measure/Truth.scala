package skein.measure

/** The paused flights that others are held against. */
object Truth:

  /** Those of the same scenario and settings, policies, period and duration; of the flight's own clock where
    * there are some. None for a paused flight.
    */
  def of(flight: FlightSummary, among: Seq[FlightSummary]): Vector[FlightSummary] =
    val same = among.toVector.filter: other =>
      other.flight.isPaused && !flight.flight.isPaused && other.headline.isDefined &&
        other.scenario == flight.scenario && other.policy == flight.policy &&
        other.flight.period == flight.flight.period && other.flight.duration == flight.flight.duration
    val ofClock = same.filter(_.flight.clock == flight.flight.clock)
    if ofClock.nonEmpty then ofClock else same

  /** What a flight comes to ([[FlightSummary.headline]]) against the mean of its truths, as a share of that:
    * 0.02 is 2 % more. Absent for a truth itself, without one, and where that came to 0.
    */
  def deviation(flight: FlightSummary, among: Seq[FlightSummary]): Option[Double] =
    for
      own   <- flight.headline
      truth <- Distribution.of(of(flight, among).flatMap(_.headline)) if truth.mean != 0
    yield own / truth.mean - 1
