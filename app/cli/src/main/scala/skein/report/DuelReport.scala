package skein.report

import skein.figures.Figure
import skein.measure.{FlightSet, FlightSummary}
import skein.scenario.{PaperDuel, ScenarioKind, Scenarios}

/** The paper's duel with its report: distances compared with those that the paper published. */
object DuelReport extends ScenarioKind(PaperDuel()), ScenarioReport:
  override def results(set: FlightSet): Vector[Section] = Vector(
    Section(
      "Distance between pursuer and evader, ours and the paper's",
      note,
      Some(SummaryTables.distances(set))
    )
  )

  override def spread(flights: Vector[FlightSummary]): Vector[Section] =
    Vector(Section("Spread", table = Some(SpreadTable.of(flights))))

  override def figures(set: FlightSet): Vector[Figure] = Figure.ofDuels(set)

  /** Skein's own scenarios, with this report of the duel. */
  val scenarios: Scenarios =
    Scenarios(Scenarios.ours.kinds.map(kind => if kind.name == name then this else kind))

  private val note =
    "Horizontal distance between pursuer and evader at equal instants of the simulator's clock; sd is its " +
      "standard deviation over the last 10 s, absent where the flight was shorter. The paper's values " +
      "are from its text and published result files; its paused flight went over the direct link."
