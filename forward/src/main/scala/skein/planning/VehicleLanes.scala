package skein.planning

import java.util.Arrays
import scala.collection.mutable
import skein.lanes.PlantLanes
import skein.vehicle.{PlaneReading, Plant, PlantState, ReducedModel}

/** One vehicle in each candidate's world: positions, m, and velocities, m/s, north and east, at the start and
  * at the end of each step; by row, then by candidate. The start is row 0. Mutable.
  */
private[planning] final class VehicleLanes(steps: Int):
  import VehicleLanes.*

  val x, y, vx, vy: Array[Float] = Array.ofDim((steps + 1) * Size)

  private val known          = mutable.HashMap.empty[(Plant[?], Double), Flight]
  private var flight         = Option.empty[Flight]
  private var last           = Option.empty[(Plant[?], Double)]
  private val startX, startY = Array.ofDim[Float](Size)

  /** Takes who flies, all from one place.
    *
    * @param origin where positions are counted from
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

  private def fill(row: Int, north: Double, east: Double, northMps: Double, eastMps: Double): Unit =
    val (from, to) = (row * Size, (row + 1) * Size)
    Arrays.fill(x, from, to, north.toFloat)
    Arrays.fill(y, from, to, east.toFloat)
    Arrays.fill(vx, from, to, northMps.toFloat)
    Arrays.fill(vy, from, to, eastMps.toFloat)

  /** Goes along a track. */
  def follow(track: PredictedTrack, origin: PlaneReading, dtS: Double): Unit =
    val (lastVx, lastVy) = (track.lastVx(dtS), track.lastVy(dtS))
    for step <- 0 until steps do
      fill(step + 1, track.x(step) - origin.northM, track.y(step) - origin.eastM, lastVx, lastVy)

  /** Flies the next step.
    *
    * @param north of each commanded velocity, over `speed`, m/s
    */
  def fly(north: Array[Float], east: Array[Float], speed: Float): Unit =
    flight.foreach(_.fly(north, east, speed))

  private def flightOf(plant: Plant[?], dtS: Double): Flight =
    val pieces = PredictedVehicle.pieces(plant, dtS)
    plant match
      case model: ReducedModel if pieces == 1 && ShortLagStep.fits(model, dtS) =>
        LagFlight(ShortLagStep(model, dtS, x, y, vx, vy))
      case _ => PlantFlight(plant, pieces, dtS / pieces)

  private final class LagFlight(step: ShortLagStep) extends Flight:
    private var row = 0

    def begin(state: Any): Unit = row = 0

    def fly(north: Array[Float], east: Array[Float], speed: Float): Unit =
      step.fly(row, north, east, speed)
      row += 1

  /** The state's numbers have a row for each piece of a step. */
  private final class PlantFlight(plant: Plant[?], pieces: Int, pieceS: Double) extends Flight:
    private val lanes  = PlantLanes.of(plant).fold(why => throw IllegalArgumentException(why), identity)
    private val step   = lanes.step.call
    private val read   = lanes.read.call
    private val count  = lanes.count
    private val states = Array.fill(count)(Array.ofDim[Float]((steps * pieces + 1) * Size))
    for (values, i) <- states.zipWithIndex do
      step.rows(i, values, 0, Size)
      step.outputRows(i, values, Size, Size)
      read.rows(i, values, pieces * Size, pieces * Size)
    for (values, i) <- Seq(x, y, vx, vy).zipWithIndex do read.outputRows(i, values, Size, Size)
    private val commandedN, commandedE = Array.ofDim[Float](Size)
    step.input(count, commandedN, 0)
    step.input(count + 1, commandedE, 0)
    step.input(count + 2, Array.fill(Size)(pieceS.toFloat), 0)
    read.input(count, startX, 0)
    read.input(count + 1, startY, 0)

    def begin(state: Any): Unit =
      for (number, i) <- PlantState.numbers(state).zipWithIndex do
        Arrays.fill(states(i), 0, Size, number.toFloat)
      step.rewind()
      read.rewind()

    def fly(north: Array[Float], east: Array[Float], speed: Float): Unit =
      var i = 0
      while i < Size do
        commandedN(i) = north(i) * speed
        commandedE(i) = east(i) * speed
        i += 1
      for _ <- 1 to pieces do step.next()
      read.next()

private object VehicleLanes:
  private final val Size = CandidateBlock.Size

  /** Kept; of more, all are compiled anew. */
  private val MostPlants = 64

  /** How a plant is flown step by step. */
  private sealed trait Flight:
    def begin(state: Any): Unit
    def fly(north: Array[Float], east: Array[Float], speed: Float): Unit
