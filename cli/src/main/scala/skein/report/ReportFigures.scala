package skein.report

import skein.figures.Figure
import skein.measure.{Deviation, FlightSet, FlightSummary, PredictionGroup}
import skein.scenario.Scenarios

/** The pictures of a report, in its order; those without anything to show are left out. Blocks for those of
  * the loops.
  */
object ReportFigures:

  def of(set: FlightSet)(using Scenarios): Vector[Figure] =
    ScenarioReport.each(set)((report, flights) => report.figures(flights)) ++ Figure.ofDetections(
      set
    ) ++ Figure.ofDecisions(set) ++
      Figure.ofDeviations(set.deviations) ++ Figure.ofPredictions(set.predictions) ++ LoopPictures.of(set)

  /** Of flights that were flown many times. */
  def spread(flights: Seq[FlightSummary]): Vector[Figure] =
    Figure.ofDeviations(Deviation.of(flights)) ++ Figure.ofPredictions(PredictionGroup.of(flights))
