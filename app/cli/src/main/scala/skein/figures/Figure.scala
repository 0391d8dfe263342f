package skein.figures

import skein.measure.{Compared, Deviation, FlightSet, PredictionErrors, PredictionGroup, ScenarioFlights}
import skein.plot.Drawing

/** A picture of the report.
  *
  * @param name the base name of its files
  * @param caption what it shows and how to read it
  */
final case class Figure(name: String, title: String, caption: String, drawing: Drawing)

object Figure:

  /** Deviations of flights from the paused flight. */
  def ofDeviations(deviations: Vector[Deviation]): Vector[Figure] =
    DeviationFigure(deviations).toVector.map: drawing =>
      Figure(
        DeviationFigure.name,
        "Deviation from the paused truth",
        "The first measure of each flight, for the duel the mean distance over the last 10 s, compared with " +
          "the paused truth, by link and loop. Discs are means over the flights, thick lines reach one standard deviation to " +
          "either side, thin lines from the least to the most; live flights are ringed.",
        drawing
      )

  /** Errors of predictions, by prediction time. */
  def ofPredictions(groups: Vector[PredictionGroup]): Vector[Figure] =
    PredictionFigure(groups).toVector.map: drawing =>
      Figure(
        PredictionFigure.name,
        "Prediction error",
        "Distance between where a vehicle was predicted to be and where it then was, " +
          "by how far its reading was carried forward, in bins of " +
          s"${PredictionErrors.BinMs} ms: medians and 95 % quantiles; " +
          s"bins with fewer than ${PredictionErrors.Fewest} predictions are left out, and one or two bins without " +
          "neighbours are discs.",
        drawing
      )

  /** Figures of flights of a pursuer and an evader, with the paper's values. */
  def ofDuels(set: FlightSet): Vector[Figure] = trajectories(set).toVector ++ DistanceFigure(set).map:
    drawing =>
      Figure(
        "distance",
        "Distance over time",
        "Horizontal distance between pursuer and evader at equal instants of the " +
          "simulator's clock. Right of each panel, mean and range over the last 10 " +
          "s of each flight: ours as coloured discs, the paper's as black diamonds; an arrow says how far a " +
          "range of the paper's goes on beyond the axis, or where its mean is.",
        drawing
      )

  /** Trajectories of the vehicles, for any flights. */
  def trajectories(set: FlightSet): Option[Figure] = TrajectoryFigure(set).map: drawing =>
    Figure(
      "trajectories",
      "Trajectories",
      "Seen from above, north up, all panels of one scale, which is that of both axes. The pursuer has " +
        "the colour of its loop, the evader is grey; rings are starts, discs are ends.",
      drawing
    )

  /** Figures of any scenario: trajectories from above and, if the vehicles climb, altitudes; and its series.
    */
  def ofScenario(flown: ScenarioFlights): Vector[Figure] =
    val name  = flown.scenario.name
    val title = flown.name.capitalize
    val above = Figure(
      s"$name-trajectories",
      s"$title: trajectories",
      "Seen from above, north up, all panels of one scale. Rings are starts, discs are ends. Where vehicles " +
        "flew the same way, the wider line is that of the earlier one in the legend. A red ring is where a limit was " +
        "broken worst.",
      ScenarioFigure.trajectories(flown)
    )
    val altitudes = Option.when(ScenarioFigure.hasAltitudes(flown))(Figure(
      s"$name-altitudes",
      s"$title: altitudes",
      "Above the origin, all panels of one scale; limits of altitude where they are near, or were broken.",
      ScenarioFigure.altitudes(flown)
    ))
    val series = flown.scenario.series.zipWithIndex.map: (one, index) =>
      Figure(
        if index == 0 then s"$name-measure" else s"$name-measure-${index + 1}",
        s"$title: ${one.name}",
        "At equal instants of the simulator's clock, one panel per link, the paused truth in each.",
        ScenarioFigure.series(flown, index)
      )
    (above +: altitudes.toVector) ++ series

  /** Camera views of flights with image recognition. */
  def ofDetections(set: FlightSet): Vector[Figure] = DetectionFigure(set).toVector.map: drawing =>
    Figure(
      "detections",
      "What cameras saw",
      "At decisive moments of each flight: drawn anew by the built-in simulator's " +
        "renderer from where the camera was at the exposure, by the image, and where the " +
        "vehicle was, by its own readings; the red box is where it was recognised.",
      drawing
    )

  /** Figures of the observations on which decisions were based. */
  def ofDecisions(set: FlightSet): Vector[Figure] = Vector(
    ObservationFigure(set).map: drawing =>
      Figure(
        "observations",
        "What decisions were made on",
        "Means over all decisions. Ages count from a reading's arrival, as " +
          "published, and so hide the network; the dashed outlines are the true " +
          "ages, from when physics was sampled." +
          (if set.flights.exists(_.published.nonEmpty) then " Diamonds are the paper's means." else ""),
        drawing
      ),
    LatencyFigure(set).map: drawing =>
      Figure(
        "latency",
        "Latency",
        "Round trips as measured in these flights (bars), and the link's profile (black line) with its 5, " +
          "50 and 95 % quantiles; direct and vpn are the paper's own samples. An emulated link takes half " +
          "of one sample there and half of another back, so its round trips spread less (orange line). The " +
          "longest may lie beyond the axis.",
        drawing
      ),
    TwinFigure(set).map: drawing =>
      Figure(
        TwinFigure.name,
        "Live against virtual",
        "Each live flight (coloured) and its virtual twins (black, dashed): shares of " +
          "decisions whose own data was at most so old, counted from when physics was " +
          "sampled, and whose own last move was at most so long ago; KS is the " +
          "Kolmogorov-Smirnov distance between the two curves: the largest vertical gap, " +
          s"where times within ${Compared.WithinMs} ms count as equal.",
        drawing
      )
  ).flatten
