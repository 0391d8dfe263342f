package skein.report

import skein.figures.Figure
import skein.measure.{FlightSet, FlightSummary, ScenarioFlights}
import skein.scenario.{ScenarioKind, Scenarios}
import skein.units.OwnFailure

/** A report's tables and pictures of one kind of scenario. A kind with its own extends this trait and
  * overrides the general ones:
  *
  * {{{
  * object PatrolKind extends ScenarioKind(Patrol()), ScenarioReport:
  *   override def figures(set: FlightSet): Vector[Figure] = super.figures(set) :+ …
  * }}}
  */
trait ScenarioReport:

  /** @param set the flights of this kind, with any settings */
  def results(set: FlightSet): Vector[Section] = set.scenarios.flatMap: flown =>
    Vector(
      Section(
        s"Results: ${flown.name}",
        ScenarioTables.note(flown.scenario),
        Some(ScenarioTables.flights(flown))
      ),
      Section(
        s"Limits broken: ${flown.name}",
        ScenarioTables.limits(flown.scenario),
        Some(ScenarioTables.violations(flown))
      )
    )

  /** Sections on the spread of many flights of each loop over each link. */
  def spread(flights: Vector[FlightSummary]): Vector[Section] = ScenarioFlights.of(flights).map(flown =>
    Section(s"Spread: ${flown.name}", table = Some(ScenarioTables.spread(flown)))
  )

  def figures(set: FlightSet): Vector[Figure] =
    set.scenarios.filter(_.flights.nonEmpty).flatMap(Figure.ofScenario)

object ScenarioReport:

  /** Calls `show` for each kind that has flights, in the registry's order; then for unknown kinds.
    *
    * @return the results, and the mistakes of kinds that threw
    */
  private[report] def each[A](set: FlightSet)(show: (ScenarioReport, FlightSet) => Vector[A])(using
      Scenarios
  ): Vector[Either[String, Vector[A]]] =
    eachName(set.all)((report, name) => show(report, set.ofKind(name)))

  private[report] def eachName[A](flights: Seq[FlightSummary])(show: (ScenarioReport, String) => Vector[A])(
      using scenarios: Scenarios
  ): Vector[Either[String, Vector[A]]] =
    val flown   = flights.map(_.flight.nameOfScenario).distinct.toVector
    val known   = scenarios.kinds.filter(kind => flown.contains(kind.name)).map(kind => (of(kind), kind.name))
    val unknown = flown.diff(scenarios.names).map((Unknown, _))
    (known ++ unknown).map: (report, name) =>
      try Right(OwnFailure.told(s"the report of the scenario $name")(show(report, name)))
      catch case failed: OwnFailure => Left(failed.getMessage)

  private def of(kind: ScenarioKind[?]): ScenarioReport = kind match
    case own: ScenarioReport => own
    case _                   => General

  private object General extends ScenarioReport

  /** The report of an unregistered kind: that of a scenario that a recording states whole, as one written in
    * Python; else trajectories, which need no scenario.
    */
  private object Unknown extends ScenarioReport:
    override def figures(set: FlightSet): Vector[Figure] =
      val known = super.figures(set)
      if known.isEmpty then Figure.trajectories(set).toVector else known
