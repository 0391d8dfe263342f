package skein.measure

import skein.record.LoopKind

/** Flights that are reported together, in the order of the paper: by link, then by loop.
  *
  * @param flights the flights, without the virtual twins of live flights
  * @param twins live flights with their virtual twins
  */
final case class FlightSet private (flights: Vector[FlightSummary], twins: Vector[Twin]):

  def links: Vector[String] = flights.map(_.flight.link).distinct

  def over(link: String): Vector[FlightSummary] = flights.filter(_.flight.link == link)

  /** The paused flight that figures show with the other flights. [[Truth]] decides with which flight each is
    * compared.
    */
  val truth: Option[FlightSummary] =
    flights.find(summary => summary.flight.isPaused && summary.policy.isEmpty)

  def ofKind(name: String): FlightSet =
    new FlightSet(
      flights.filter(_.flight.nameOfScenario == name),
      twins.filter(_.live.flight.nameOfScenario == name)
    )

  val scenarios: Vector[ScenarioFlights] = ScenarioFlights.of(flights)

  def all: Vector[FlightSummary] = flights ++ twins.flatMap(_.virtual).distinct

  def deviations: Vector[Deviation] = Deviation.of(all)

  def predictions: Vector[PredictionGroup] = PredictionGroup.of(flights)

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
    val named = FlightNames.apart(ordered)
    val twins = Twin.among(named)
    new FlightSet(named.diff(twins.flatMap(_.virtual)), twins)
