package skein.report

import skein.measure.{Distribution, ScenarioFlights}
import skein.record.EventKind
import skein.scenario.{Measured, Scenario}
import skein.settings.NamedScene
import skein.units.Decimals.fixed

/** Tables of a scenario's measures, limits and spreads. */
object ScenarioTables:

  /** A row per flight: its measures, the deviation of the first measure from that of the paused flight, and
    * the RMS distance of the vehicles from their positions in the paused flight at equal times.
    */
  def flights(flown: ScenarioFlights): TextTable =
    val names  = flown.scenario.measures.map(_.title)
    val header = Vector("<loop", "<link", "flown s") ++ withPaused(names, "vs paused") ++
      contactsTitle(flown) :+ "off truth m"
    val flights = flown.flights.map: flight =>
      val cells = flight.result.measured.map(text)
      Vector(
        flight.summary.name,
        flight.summary.flight.link,
        flight.summary.flownS.fixed(1)
      ) ++ withPaused(cells, SummaryTables.againstTruth(flight.summary, flown.deviation(flight))) ++
        contactsTitle(flown).map(_ => contacts(flight).toString) :+
        flown.offTruthM(flight).fold("")(_.fixed(2))
    val without =
      flown.withoutResult.map(one => Vector(one.name, one.flight.link).padTo(header.size, ""))
    TextTable(header, flights ++ without)

  /** The contacts column's title, if the scene has objects or a contact happened. */
  private def contactsTitle(flown: ScenarioFlights): Option[String] =
    Option.when(
      NamedScene.shipped(flown.scenario.scene).exists(!_.isEmpty) || flown.flights.exists(contacts(_) > 0)
    )("contacts")

  private def contacts(flight: ScenarioFlights.Flown): Int = flight.summary.count(EventKind.Contact)

  /** Inserts a cell after the first measure, if there is any. */
  private def withPaused(cells: Vector[String], against: String): Vector[String] =
    cells.take(1) ++ cells.headOption.map(_ => against) ++ cells.drop(1)

  /** A row per flight and limit that was broken in it, with the first and the worst violation. */
  def violations(flown: ScenarioFlights): TextTable = TextTable(
    Vector("<loop", "<link", "<limit", "times", "<vehicles", "from s", "to s", "worst", "at s"),
    for
      flight          <- flown.flights
      (limit, broken) <- flown.scenario.limits.map(limit =>
        (
          limit,
          flight.result.violations.filter(one =>
            one.limit.text == limit.text && one.limit.value == limit.value
          )
        )
      )
      (one, index) <- broken.take(MostListed).zipWithIndex
    yield
      val first = index == 0
      Vector(
        if first then flight.summary.name else "",
        if first then flight.summary.flight.link else "",
        if first then limit.text else "",
        if first then broken.size.toString else "",
        one.vehicles.map(flown.scenario.agents(_).name).mkString(", "),
        one.fromS.fixed(2),
        one.toS.fixed(2),
        one.worst.fixed(2),
        one.worstAtS.fixed(2)
      )
  )

  def limits(scenario: Scenario): String =
    s"Limits: ${scenario.limits.map(_.text).mkString("; ")}. A row is a stretch of time in which a " +
      s"vehicle or a pair broke one; the first $MostListed of each flight and limit are listed."

  private val MostListed = 5

  /** A row per loop and link. For each measure: mean ± standard deviation, least … most over the flights, and
    * how many flights have no value, and why. For counts: the total, and the number of flights with any.
    */
  def spread(flown: ScenarioFlights): TextTable =
    val groups = flown.flights.groupBy(flight => (flight.summary.name, flight.summary.flight.link))
    val order  = flown.flights.map(flight => (flight.summary.name, flight.summary.flight.link)).distinct
    val names  = flown.scenario.measures.map(_.title)
    TextTable(
      Vector("<loop", "<link", "flights") ++ names ++ contactsTitle(flown) :+ "off truth m",
      order.map: group =>
        val flights = groups(group)
        Vector(group._1, group._2, flights.size.toString) ++
          names.indices.map(index => summed(flights.map(_.result.measured(index)))) ++
          contactsTitle(flown).map(_ => inFlights(flights.map(contacts(_).toDouble))) :+
          spreadText(flights.flatMap(flown.offTruthM))
    )

  private def summed(measures: Vector[Measured]): String =
    val values = measures.flatMap(_.value)
    if measures.head.measure.isCount then inFlights(values)
    else
      val missing  = measures.filter(_.value.isEmpty)
      val tooShort = missing.count(_.isTooShort)
      val never    = missing.size - tooShort
      val reasons  = Seq((never, Never), (tooShort, TooShort)).collect:
        case (count, why) if count > 0 => s"$count $why"
      (Option.when(values.nonEmpty)(spreadText(values)) ++ reasons).mkString(", ")

  private def inFlights(counts: Vector[Double]): String =
    s"${counts.sum.fixed(0)} in ${counts.count(_ > 0)} flights"

  private def spreadText(values: Vector[Double]): String =
    def two(value: Double) = value.fixed(2)
    Distribution.of(values).fold("")(all =>
      if all.count == 1 then two(all.mean)
      else s"${two(all.mean)} ± ${two(all.sampleSd)}, ${two(all.least)} … ${two(all.most)}"
    )

  /** The text for an event that did not occur in the flight. */
  private val Never = "never"

  /** The text for a flight that ended before the measured part, such as its last 10 s. */
  private val TooShort = "too short"

  private def text(measured: Measured): String = measured.value match
    case None if measured.isTooShort             => TooShort
    case None                                    => Never
    case Some(value) if measured.measure.isCount => value.fixed(0)
    case Some(value)                             => value.fixed(2)

  def note(scenario: Scenario): String =
    s"${scenario.note} Off truth: root mean square distance of the vehicles from where they are in the paused truth at the same time.".trim
