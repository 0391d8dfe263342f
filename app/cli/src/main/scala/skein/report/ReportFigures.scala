package skein.report

import skein.figures.Figure
import skein.measure.{Deviation, FlightSet, FlightSummary, PredictionGroup}
import skein.scenario.Scenarios

/** The pictures of a report, in order; empty ones are left out.
  *
  * @param failures the failures of scenarios whose pictures are missing because their code threw
  */
final case class ReportFigures(all: Vector[Figure] = Vector.empty, failures: Vector[String] = Vector.empty)

object ReportFigures:

  /** All figures; blocks while it starts the loops. */
  def of(set: FlightSet)(using Scenarios): ReportFigures =
    val (failures, own) =
      ScenarioReport.each(set)((report, flights) => report.figures(flights)).partitionMap(identity)
    ReportFigures(
      own.flatten ++ Figure.ofDetections(set) ++ Figure.ofDecisions(set) ++
        Figure.ofDeviations(set.deviations) ++ Figure.ofPredictions(set.predictions) ++ LoopPictures.of(set),
      failures
    )

  /** Figures on the spread of repeated flights. */
  def spread(flights: Seq[FlightSummary]): ReportFigures =
    ReportFigures(
      Figure.ofDeviations(Deviation.of(flights)) ++ Figure.ofPredictions(PredictionGroup.of(flights))
    )
