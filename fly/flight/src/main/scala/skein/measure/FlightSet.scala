package skein.measure

import skein.record.LoopKind

/** Flights that are reported together; in the order of the paper: by link, then by loop.
  *
  * @param flights without the virtual twins of live flights
  * @param twins live flights beside their virtual twins
  */
final case class FlightSet private (flights: Vector[FlightSummary], twins: Vector[Twin]):

  def links: Vector[String] = flights.map(_.flight.link).distinct

  def over(link: String): Vector[FlightSummary] = flights.filter(_.flight.link == link)

  /** The paused flight that figures show beside the others. What each is measured against, [[Truth]] says. */
  val truth: Option[FlightSummary] =
    flights.find(summary => summary.flight.isPaused && summary.policy.isEmpty)

  /** Those of one kind of scenario. */
  def ofKind(name: String): FlightSet =
    new FlightSet(
      flights.filter(_.flight.nameOfScenario == name),
      twins.filter(_.live.flight.nameOfScenario == name)
    )

  /** By scenario. */
  val scenarios: Vector[ScenarioFlights] = ScenarioFlights.of(flights)

  /** Twins' virtual flights included. */
  def all: Vector[FlightSummary] = flights ++ twins.flatMap(_.virtual).distinct

  /** By loop, link and clock. */
  def deviations: Vector[Deviation] = Deviation.of(all)

  /** By loop and link. */
  def predictions: Vector[PredictionGroup] = PredictionGroup.of(flights)

  /** What a flight comes to against its [[Truth]]. */
  def deviation(flight: FlightSummary): Option[Double] = truths.deviation(flight)

  private lazy val truths = Truth.among(all)

object FlightSet:
  private val linkOrder = Vector("none", "direct", "vpn", "vpn-mixed")

  def apply(flights: Seq[FlightSummary]): FlightSet =
    def place(order: Vector[String], name: String) =
      Some(order.indexOf(name)).filter(_ >= 0).getOrElse(order.size)
    val ordered = flights.toVector.sortBy: summary =>
      (
        place(linkOrder, summary.flight.link),
        summary.flight.link,
        summary.flight.loopKind.fold(LoopKind.values.length)(_.ordinal),
        summary.policy.isDefined,
        summary.solver.isDefined
      )
    val twins = Twin.among(ordered)
    new FlightSet(ordered.diff(twins.flatMap(_.virtual)), twins)
