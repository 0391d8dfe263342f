package skein.figures

import skein.measure.{Deviation, FlightSet, FlightSummary, PredictionErrors, PredictionGroup, TeamFlights}
import skein.plot.Drawing

/** A picture of the report.
  *
  * @param name
  *   of its files
  * @param caption
  *   what it shows and how to read it
  */
final case class Figure(name: String, title: String, caption: String, drawing: Drawing)

object Figure:

  /** The pictures that the flights give; those without anything to show are left out. */
  def all(set: FlightSet): Vector[Figure] =
    duels(set.duels) ++ set.teams.flatMap(ofTeam) ++ ofDecisions(set) ++
      ofDeviations(set.deviations) ++ ofPredictions(set.predictions)

  /** The pictures of flights that were flown many times. */
  def spread(flights: Seq[FlightSummary]): Vector[Figure] =
    ofDeviations(Deviation.of(flights)) ++ ofPredictions(PredictionGroup.of(flights))

  private def ofDeviations(deviations: Vector[Deviation]): Vector[Figure] =
    DeviationFigure(deviations).toVector.map: drawing =>
      Figure(
        DeviationFigure.name,
        "Deviation from the paused truth",
        "Mean distance of the last 10 s against the truth's, by link and loop. Discs are means over the flights, thick lines " +
          "reach one standard deviation to either side, thin lines from the least to the most; live flights are ringed.",
        drawing
      )

  private def ofPredictions(groups: Vector[PredictionGroup]): Vector[Figure] =
    PredictionFigure(groups).toVector.map: drawing =>
      Figure(
        PredictionFigure.name,
        "Prediction error against age",
        "Distance between where a vehicle was predicted to be and where it then was, by how far its reading was carried " +
          s"forward, in bins of ${PredictionErrors.BinMs} ms; full lines are medians, dashed ones 95 % quantiles.",
        drawing
      )

  private def duels(set: FlightSet): Vector[Figure] = Vector(
    TrajectoryFigure(set).map: drawing =>
      Figure(
        "trajectories",
        "Trajectories",
        "Seen from above, north up, with equal scales on both axes of a panel. The pursuer has the colour of its " +
          "loop, the evader is grey; rings are starts, discs are ends.",
        drawing
      ),
    DistanceFigure(set).map: drawing =>
      Figure(
        "distance",
        "Distance over time",
        "Horizontal distance between pursuer and evader at equal instants of the simulator's clock. Right of each " +
          "panel, mean and range over the last 10 s: ours as coloured discs, the paper's as black diamonds.",
        drawing
      )
  ).flatten

  private def ofTeam(flown: TeamFlights): Vector[Figure] = Vector(
    Figure(
      s"${flown.scenario}-trajectories",
      s"${flown.scenario.capitalize}: trajectories",
      "Seen from above, north up, all panels of one scale. Rings are starts, discs are ends.",
      TeamFigure.trajectories(flown)
    ),
    Figure(
      s"${flown.scenario}-measure",
      s"${flown.scenario.capitalize}: ${flown.flights.head.result.curveName}",
      "At equal instants of the simulator's clock, one panel per link, the paused truth in each.",
      TeamFigure.measure(flown)
    )
  )

  private def ofDecisions(set: FlightSet): Vector[Figure] = Vector(
    ObservationFigure(set).map: drawing =>
      Figure(
        "observations",
        "What decisions were made on",
        "Means over all decisions. Ages count from a reading's arrival, as published, and so hide the network; the " +
          "dashed outlines are the true ages, from when physics was sampled. Diamonds are the paper's means.",
        drawing
      ),
    LatencyFigure(set).map: drawing =>
      Figure(
        "latency",
        "Latency",
        "Round trips as measured in these flights (bars), and the link's profile (black line) with its 5, 50 and " +
          "95 % quantiles; direct and vpn are the paper's own samples. An emulated link takes half of one sample there " +
          "and half of another back, so its round trips spread less (orange line).",
        drawing
      ),
    TwinFigure(set).map: drawing =>
      Figure(
        TwinFigure.name,
        "Live against virtual",
        "Each live flight (coloured) and its virtual twins (black, dashed): shares of decisions whose own data was at most " +
          "so old, counted from when physics was sampled, and whose own last move was at most so long ago; KS is the " +
          "Kolmogorov-Smirnov distance between the two curves, the largest vertical gap.",
        drawing
      )
  ).flatten
