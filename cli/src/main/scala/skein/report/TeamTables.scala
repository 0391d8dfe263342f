package skein.report

import skein.measure.{CrossingMeasures, Distribution, FormationMeasures, Measure, Numbers, TeamFlights}
import skein.policy.TeamScenario

/** Tables of teams' flights, one per scenario. */
object TeamTables:

  /** A row per flight: its measures, the first against the paused truth's, and how far the vehicles were from where they
    * are in the paused truth at the same time.
    */
  def flights(flown: TeamFlights): TextTable =
    val names = flown.flights.head.result.measures.map(_.name)
    TextTable(
      Vector("<loop", "<link", "flown s") ++ names.take(1) ++ Vector("vs paused") ++ names.drop(1) ++
        Vector("off truth m"),
      flown.flights.map: flight =>
        val cells = flight.result.measures.map(text)
        Vector(
          flight.summary.flight.loop,
          flight.summary.flight.link,
          Numbers.fixed(flight.summary.flownS, 1)
        ) ++ cells.take(1) ++
          Vector(flown.deviation(flight).fold("")(share => s"${Numbers.signed(share * 100)} %")) ++
          cells.drop(1) ++
          Vector(flown.offTruthM(flight).fold("")(Numbers.fixed(_, 2)))
    )

  /** A row per loop and link: of each measure mean ± standard deviation, least … most over the flights; of counts the
    * total and the flights that have any.
    */
  def spread(flown: TeamFlights): TextTable =
    val groups = flown.flights.groupBy(flight => (flight.summary.flight.loop, flight.summary.flight.link))
    val order  =
      flown.flights.map(flight => (flight.summary.flight.loop, flight.summary.flight.link)).distinct
    val names = flown.flights.head.result.measures.map(_.name)
    TextTable(
      Vector("<loop", "<link", "flights") ++ names :+ "off truth m",
      order.map: group =>
        val flights = groups(group)
        Vector(group._1, group._2, flights.size.toString) ++
          names.indices.map(index => summed(flights.map(_.result.measures(index)))) :+
          spreadText(flights.flatMap(flown.offTruthM))
    )

  private def summed(measures: Vector[Measure]): String =
    val values = measures.flatMap(_.value)
    if measures.head.isCount then
      s"${Numbers.fixed(values.sum, 0)} in ${values.count(_ > 0)} flights"
    else
      val missing = measures.size - values.size
      spreadText(values) + (if missing > 0 then s", $missing never" else "")

  private def spreadText(values: Vector[Double]): String =
    def two(value: Double) = Numbers.fixed(value, 2)
    Distribution.of(values).fold("")(all =>
      s"${two(all.mean)} ± ${two(all.sd)}, ${two(all.least)} … ${two(all.most)}"
    )

  private def text(measure: Measure): String = measure.value match
    case None                           => "never"
    case Some(value) if measure.isCount => Numbers.fixed(value, 0)
    case Some(value)                    => Numbers.fixed(value, 2)

  /** What a table's columns mean. */
  def note(scenario: TeamScenario): String =
    val means = scenario match
      case surround: TeamScenario.Surround =>
        s"Over the last 10 s: how far the pursuers are from the ring of ${surround.ringM} m, root mean square; their mean " +
          "distance to the evader, the smallest, and the mean of the largest angle between neighbours as the evader sees them " +
          f"(${360.0 / (surround.vehicles - 1)}%.0f° is even); surrounded: from when on no such angle reaches 180°."
      case _: TeamScenario.Formation =>
        s"Distance of the followers to their slots after the first ${FormationMeasures.settlingS} s: root mean square, and " +
          "the largest."
      case crossing: TeamScenario.Crossing =>
        s"Smallest separation of any two vehicles, and how often two came nearer than the set minimum of " +
          s"${crossing.minimumM} m; arrived: within ${CrossingMeasures.arrivedM} m of the goal."
    s"$means Off truth: root mean square distance of the vehicles from where they are in the paused truth at the same time."
