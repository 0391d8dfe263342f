package skein.scenario

import skein.policy.*
import skein.units.Decimals.significant
import skein.units.Metres

/** Streams of vehicles cross at right angles; each vehicle flies to a goal beyond the crossing and avoids all
  * other vehicles.
  *
  * @param vehicles number of vehicles, in all streams
  * @param streams number of streams: 2, to the north and to the east, or 4
  * @param spacingM distance between two vehicles of a stream
  * @param entryM distance from the first vehicle of a stream to the middle of the crossing, at the start
  * @param laneM distance by which each stream keeps to the right of the middle
  * @param cruiseMps speed of a vehicle that need not avoid any other
  * @param mostMps maximum commanded speed
  * @param minimumM smallest separation allowed, which is a limit of the scenario
  * @param marginM distance that the avoidance rule adds to the minimum, because the rule ignores that
  *   vehicles lag behind their commands
  * @param horizonS time ahead for which the avoidance rule plans, s
  * @param altitudeM altitude of all vehicles
  */
final case class Crossing(
    vehicles: Int = 20,
    streams: Int = 4,
    spacingM: Double = 6,
    entryM: Double = 25,
    laneM: Double = 4,
    cruiseMps: Double = 8,
    mostMps: Double = 10,
    minimumM: Double = 2,
    marginM: Double = 1,
    horizonS: Double = 3,
    altitudeM: Double = 5
) extends Scenario:
  import Crossing.*

  override def mistakes: Seq[String] =
    Scenario.outside("vehicles", vehicles, 2, AtOneAltitude.MostVehicles).toSeq ++
      Scenario.notPositive(this, "laneM", "marginM") ++
      Option.when(streams != 2 && streams != 4)(s"streams: expected 2 or 4, got $streams")

  def agents: Vector[Agent] = routes.zipWithIndex.map: (route, vehicle) =>
    val (northM, eastM)         = onLane(route.headingRad, route.startM)
    val (goalNorthM, goalEastM) = onLane(route.headingRad, route.goalM)
    val policy = Avoidance(goalNorthM, goalEastM, cruiseMps, mostMps, minimumM, marginM, horizonS)
    val name   = s"Vehicle${vehicle + 1}"
    AtOneAltitude.agent(name, Role.Traveller, cruiseMps, northM, eastM, altitudeM, route.headingRad, policy)

  override def limits: Vector[Limit] = Vector(separation)

  override def series: Vector[Series] = Vector(smallest)

  override def measures: Vector[Measure] = Vector(
    smallest.least("closest"),
    smallest.leastAt("at"),
    Measure.join("violations", "", violations, isCount = true)(counts => Some(counts.flatten.sum)),
    Measure.join("arrived", "", arrivals, isCount = true)(timesS => Some(timesS.flatten.size)),
    Measure.join("to goal", "s", arrivals): timesS =>
      val reached = timesS.flatten
      Option.when(reached.nonEmpty)(reached.sum / reached.size)
    ,
    Measure.join("per min", "", arrivals): timesS =>
      val reached = timesS.flatten
      reached.maxOption.map(reached.size / _ * 60)
  )

  override def note: String =
    "Smallest separation of any two vehicles, and how often two came nearer than the " +
      s"set minimum of ${minimumM.significant(3)} m; arrived: within ${ArrivedM.significant(3)} m of the goal."

  override def shade(vehicle: Int): Int = vehicle % streams

  /** Goals of the vehicles, north and east, m. */
  def goals: Vector[(Double, Double)] = routes.map(route => onLane(route.headingRad, route.goalM))

  private def separation = Limit.horizontalSeparation(Metres(minimumM))

  private def smallest =
    Series.of("smallest separation", "m", Separation, Some(Bound("set minimum", minimumM)))

  /** When each vehicle arrives at its goal, if it does, s. */
  private def arrivals: Vector[Measure] = goals.zipWithIndex.map: (goal, vehicle) =>
    val (north, east) = goal
    Series.of("to the goal", "m", FromPlace(vehicle, north, east)).firstBelow("arrival", ArrivedM)

  /** By pair of vehicles, how often they were nearer to one another than allowed. */
  private def violations: Vector[Measure] =
    for one <- Vector.range(1, vehicles); other <- Vector.range(0, one)
    yield Series.of("separation", "m", Apart(one, other)).timesBelow("violations", minimumM)

  /** The routes by vehicle. Vehicles are assigned to the streams in turn; those of one stream fly one behind
    * the other. The first of a stream has the farthest goal, so that all fly equally far and none waits on
    * another's route.
    */
  private def routes: Vector[Route] =
    Vector.tabulate(vehicles): vehicle =>
      val (stream, rank) = (vehicle % streams, vehicle / streams)
      val lastRank       = (vehicles - 1 - stream) / streams
      Route(
        headingRad = stream * math.Pi / 2,
        startM = -(entryM + rank * spacingM),
        goalM = entryM + (lastRank - rank) * spacingM
      )

  private def onLane(headingRad: Double, alongM: Double): (Double, Double) =
    val (cos, sin) = (StrictMath.cos(headingRad), StrictMath.sin(headingRad))
    (alongM * cos - laneM * sin, alongM * sin + laneM * cos)

object Crossing:
  /** Distance from its goal within which a vehicle counts as arrived, m. */
  private val ArrivedM = 3.0

  /** A straight route: positions along the heading, from the middle of the crossing, m. */
  private final case class Route(headingRad: Double, startM: Double, goalM: Double)
