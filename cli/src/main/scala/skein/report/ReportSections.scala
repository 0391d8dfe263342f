package skein.report

import skein.figures.{DeviationFigure, Figure, PredictionFigure, TwinFigure}
import skein.measure.{Deviation, FlightSet, FlightSummary, PredictionGroup, TeamFlights}

/** What a report consists of, in its order. Sections without anything to show are left out. */
object ReportSections:

  /** @param figures
    *   as [[Figure.all]] gives them; none, where only tables are shown
    */
  def of(set: FlightSet, figures: Seq[Figure] = Nil): Vector[Section] =
    val duels = Section(
      "Distance between pursuer and evader, ours and the paper's",
      resultsNote,
      Option.when(set.duels.flights.nonEmpty)(SummaryTables.distances(set.duels))
    )
    val teams = set.teams.map(flown =>
      Section(
        s"Results: ${flown.scenario}",
        TeamTables.note(flown.flights.head.result.scenario),
        Some(TeamTables.flights(flown))
      )
    )
    val pictures = figures.toVector.filterNot(figure => withTables(figure.name)).map(figure =>
      Section(figure.title, figures = Vector(figure))
    )
    shown(
      (duels +: teams) ++ pictures ++ compared(set.deviations, set.predictions, figures) ++ Vector(
        Section(
          "Live against virtual",
          SummaryTables.twinsNote.capitalize + ".",
          Some(SummaryTables.twins(set)),
          named(TwinFigure.name, figures)
        ),
        Section(PlanTable.title, s"${PlanTable.note(set)}.", Some(PlanTable.of(set))),
        Section("Observations per decision, ms", observationsNote, Some(SummaryTables.observations(set))),
        Section("What happened: drops, skips and time-outs", "", Some(SummaryTables.counts(set)))
      )
    )

  /** All of a report, for the terminal: the tables, how far each loop was off the truth, and what was cut short. */
  def text(set: FlightSet): String =
    val said = Vector(
      Verdict.sentences(set.deviations),
      SummaryTables.cutShort(set)
    ).filter(_.nonEmpty).map(_.mkString("\n"))
    (Section.text(of(set)) +: said).mkString("\n\n")

  /** What many flights of each loop over each link come to. */
  def spread(flights: Seq[FlightSummary], figures: Seq[Figure] = Nil): Vector[Section] =
    val duels = flights.filter(_.team.isEmpty)
    val teams = TeamFlights.of(flights.toVector).map(flown =>
      Section(s"Spread: ${flown.scenario}", table = Some(TeamTables.spread(flown)))
    )
    shown(
      (Section("Spread", table = Option.when(duels.nonEmpty)(SpreadTable.of(duels))) +: teams) ++
        compared(Deviation.of(flights), PredictionGroup.of(flights), figures)
    )

  private def compared(
      deviations: Vector[Deviation],
      predictions: Vector[PredictionGroup],
      figures: Seq[Figure]
  ): Vector[Section] = Vector(
    Section(
      "Deviation from the paused truth",
      "",
      Some(DeviationTable.of(deviations)),
      named(DeviationFigure.name, figures)
    ),
    Section(
      "Prediction error against age",
      "",
      Some(PredictionTable.of(predictions)),
      named(PredictionFigure.name, figures)
    )
  )

  private def shown(sections: Vector[Section]): Vector[Section] =
    sections.filter(section => section.table.exists(_.rows.nonEmpty) || section.figures.nonEmpty)

  /** Figures that stand beside a table of their own. */
  private val withTables = Set(TwinFigure.name, DeviationFigure.name, PredictionFigure.name)

  private def named(name: String, figures: Seq[Figure]): Vector[Figure] =
    figures.filter(_.name == name).toVector

  private val resultsNote =
    "Horizontal distance between pursuer and evader at equal instants of the simulator's clock; sd is the standard " +
      "deviation over the last 10 s, which a flight has that lasted as long. The paper's values are from its text and published result files; its paused flight " +
      "went over the direct link."

  private val observationsNote =
    "Mean/median/99th percentile in ms, by the role that was decided for. Ages count from the arrival of the reading used, as published; the true " +
      "ages, means, count from when physics was sampled, by the simulator's clock."
