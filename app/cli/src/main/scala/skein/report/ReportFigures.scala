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
      numbered(
        own.flatten ++ Figure.ofDetections(set) ++ Figure.ofDecisions(set) ++
          Figure.ofDeviations(set.deviations) ++ Figure.ofPredictions(set.predictions) ++ LoopPictures.of(set)
      ),
      failures
    )

  /** Figures with names of their own: each is a file. Of one name are those of a scenario with several
    * settings.
    */
  private[report] def numbered(figures: Vector[Figure]): Vector[Figure] =
    figures.foldLeft(Vector.empty[Figure]): (before, figure) =>
      val taken = before.map(_.name).toSet
      val names = Iterator(figure.name) ++ Iterator.from(2).map(number => s"${figure.name}-$number")
      before :+ figure.copy(name = names.find(!taken(_)).get)

  /** Figures on the spread of repeated flights. */
  def spread(flights: Seq[FlightSummary]): ReportFigures =
    ReportFigures(
      Figure.ofDeviations(Deviation.of(flights)) ++ Figure.ofPredictions(PredictionGroup.of(flights))
    )
