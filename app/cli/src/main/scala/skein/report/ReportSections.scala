package skein.report

import skein.figures.{DeviationFigure, Figure, PredictionFigure, TwinFigure}
import skein.measure.{Deviation, FlightSet, FlightSummary, PredictionGroup}
import skein.scenario.Scenarios

/** The sections of a report, in order; empty ones are left out. */
object ReportSections:

  /** @param figures the report's figures, by [[ReportFigures.of]]; empty for tables only */
  def of(set: FlightSet, figures: ReportFigures = ReportFigures())(using Scenarios): Vector[Section] =
    val results  = orFailures(ScenarioReport.each(set)((report, flights) => report.results(flights)))
    val pictures = figures.all.filterNot(figure => withTables(figure.name)).map(figure =>
      Section(figure.title, figures = Vector(figure))
    )
    shown(
      results ++ figures.failures.map(failed) ++ pictures ++ compared(
        set.deviations,
        set.predictions,
        figures
      ) ++ Vector(
        Section(
          "Live against virtual",
          SummaryTables.twinsNote.capitalize + ".",
          Some(SummaryTables.twins(set)),
          named(TwinFigure.name, figures)
        ),
        Section(SolverTable.title, SolverTable.note, Some(SolverTable.of(set))),
        Section(PlanTable.title, s"${PlanTable.note(set)}.", Some(PlanTable.of(set))),
        Section("Seen", SummaryTables.seenNote, Some(SummaryTables.seen(set.flights))),
        Section("Observations per decision, ms", observationsNote, Some(SummaryTables.observations(set))),
        Section("What happened: drops, skips and time-outs", "", Some(SummaryTables.counts(set)))
      )
    )

  /** A whole report for the terminal: the tables, each loop's deviation from the paused flight, remarks on
    * single flights, and whether the timing was good enough.
    */
  def text(set: FlightSet)(using Scenarios): String =
    val said = Vector(
      Verdict.sentences(set.deviations),
      SummaryTables.remarks(set),
      TimingVerdict.sentence(set).toVector
    ).filter(_.nonEmpty).map(_.mkString("\n"))
    (Section.text(of(set)) +: said.map(TextTable.printable)).mkString("\n\n")

  /** Sections on the spread of many flights of each loop over each link. */
  def spread(flights: Seq[FlightSummary], figures: ReportFigures = ReportFigures())(using
      Scenarios
  ): Vector[Section] =
    val results = orFailures(ScenarioReport.eachName(flights)((report, name) =>
      report.spread(flights.filter(_.flight.nameOfScenario == name).toVector)
    ))
    shown(results ++ compared(Deviation.of(flights), PredictionGroup.of(flights), figures))

  private def orFailures(results: Vector[Either[String, Vector[Section]]]): Vector[Section] =
    results.flatMap(_.fold(failure => Vector(failed(failure)), identity))

  private def failed(failure: String) = Section("Missing", failure = Some(failure))

  private def compared(
      deviations: Vector[Deviation],
      predictions: Vector[PredictionGroup],
      figures: ReportFigures
  ): Vector[Section] = Vector(
    Section(
      "Deviation from the paused truth",
      "",
      Some(DeviationTable.of(deviations)),
      named(DeviationFigure.name, figures)
    ),
    Section(
      "Prediction error",
      predictionNote,
      Some(PredictionTable.of(predictions)),
      named(PredictionFigure.name, figures)
    )
  )

  private[report] def shown(sections: Vector[Section]): Vector[Section] =
    sections.filter(section =>
      section.table.exists(_.rows.nonEmpty) || section.figures.nonEmpty || section.failure.nonEmpty
    )

  /** Figures that are shown next to a table of their own. */
  private val withTables = Set(TwinFigure.name, DeviationFigure.name, PredictionFigure.name)

  private def named(name: String, figures: ReportFigures): Vector[Figure] = figures.all.filter(_.name == name)

  private val predictionNote =
    "Distance of predicted positions from readings of the same moment. Carried by: median time from the " +
      "reading to the moment predicted for. Unverified: no reading came to compare with."

  private val observationsNote =
    "Mean/median/99th percentile in ms, by the role that decides. Ages count from the arrival of the " +
      "reading used, as in the paper. The true ages are means, and count from when physics was sampled, " +
      "by the simulator's clock."
