package skein.planning

import java.util.Arrays
import scala.collection.mutable
import skein.lanes.plant.PlantLanes
import skein.units.eachBelow
import skein.vehicle.{PlaneReading, Plant, PlantState, ReducedModel}

/** The track of one vehicle in each candidate's world. For the start and for the end of each step, `way` has
  * four rows: north and east, m, and velocity north and east, m/s. Mutable.
  */
private[planning] final class VehicleLanes(steps: Int):
  import VehicleLanes.*

  val way: Array[Float] = Array.ofDim((steps + 1) * Apart)

  private val known          = mutable.HashMap.empty[(Plant[?], Double), Flight]
  private var flight         = Option.empty[Flight]
  private var last           = Option.empty[(Plant[?], Double)]
  private val startX, startY = Array.ofDim[Float](Size)

  /** Sets the vehicle, in one initial state for all candidates.
    *
    * @param origin position to which all positions are relative
    */
  def take(vehicle: PredictedVehicle[?], origin: PlaneReading, dtS: Double): Unit =
    if known.size >= MostPlants then known.clear()
    val at = vehicle.motion
    val of = (vehicle.plant, dtS)
    if !last.exists(each => (each(0) eq of(0)) && each(1) == dtS) then
      flight = Some(known.getOrElseUpdate(of, flightOf(vehicle.plant, dtS)))
      last = Some(of)
    Arrays.fill(startX, (vehicle.northM - origin.northM).toFloat)
    Arrays.fill(startY, (vehicle.eastM - origin.eastM).toFloat)
    fill(0, at.northM - origin.northM, at.eastM - origin.eastM, at.northMps, at.eastMps)
    flight.foreach(_.begin(vehicle.state))

  private def fill(step: Int, north: Double, east: Double, northMps: Double, eastMps: Double): Unit =
    fill(row(step, 0), north)
    fill(row(step, 1), east)
    fill(row(step, 2), northMps)
    fill(row(step, 3), eastMps)

  private def fill(from: Int, value: Double): Unit = Arrays.fill(way, from, from + Size, value.toFloat)

  def follow(track: PredictedTrack, origin: PlaneReading, dtS: Double): Unit =
    val (lastVx, lastVy) = (track.lastVx(dtS), track.lastVy(dtS))
    for step <- 0 until steps do
      fill(step + 1, track.x(step) - origin.northM, track.y(step) - origin.eastM, lastVx, lastVy)

  /** Simulates the next step.
    *
    * @param north north component of each commanded velocity, divided by `speed`
    */
  def fly(north: Array[Float], east: Array[Float], speed: Float): Unit =
    flight.foreach(_.fly(north, east, speed))

  private def flightOf(plant: Plant[?], dtS: Double): Flight =
    val pieces = PredictedVehicle.pieces(plant, dtS)
    val flown  = plant match
      case model: ReducedModel if pieces == 1 && ShortLagSteps.fits(model, dtS) => ShortLagSteps(model)
      case _                                                                    => plant
    Flight(flown, pieces, dtS / pieces)

  /** Simulates a plant in steps of equal duration. */
  private final class Flight(plant: Plant[?], pieces: Int, pieceS: Double):
    private val lanes  = PlantLanes.of(plant).fold(why => throw IllegalArgumentException(why), identity)
    private val count  = lanes.count
    private val isWay  = pieces == 1 && lanes.steps.isRead
    private val call   = lanes.steps.call(plant, pieceS, reads = !isWay)
    private val apart  = if isWay then Apart else (count + Numbers) * Size
    private val states = if isWay then way else Array.ofDim[Float](2 * apart)
    private val starts = Array(startX, startY)
    private var step   = 0
    call.rows(states, 0, apart)
    call.outputRows(states, apart, apart)
    call.starts(startX, startY)

    def begin(state: Any): Unit =
      call.rewind()
      step = 0
      if !isWay then
        for (number, i) <- PlantState.numbers(state).zipWithIndex do
          Arrays.fill(states, i * Size, (i + 1) * Size, number.toFloat)
        for places <- lanes.steps.places; axis <- 0 to 1; world <- 0 until Size do
          states(places(axis) * Size + world) += starts(axis)(world)

    def fly(north: Array[Float], east: Array[Float], speed: Float): Unit =
      call.command(north, east, speed)
      eachBelow(pieces)(_ => call.next())
      step += 1
      if !isWay then
        val flown = step * pieces % 2 * apart
        System.arraycopy(states, flown + count * Size, way, row(step, 0), Apart)

private[planning] object VehicleLanes:
  private final val Size = CandidateBlock.Size

  private final val Numbers = 4

  /** Distance between the rows of successive steps, floats. */
  final val Apart = Numbers * Size

  private val MostPlants = 64

  /** Index of a row in `way`: 0 north, 1 east, 2 velocity north, 3 velocity east. */
  def row(step: Int, number: Int): Int = step * Apart + number * Size
