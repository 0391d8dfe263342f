package skein.lanes.plant

import java.util.Arrays
import java.util.concurrent.ConcurrentHashMap
import skein.formula.{Formula, Untraceable}
import skein.simd.{FixedFormula, Forms, LaneFunction}
import skein.vehicle.{DrivenCar, PlaneReading, Plant, PlantState, PlantTiming, SpatialPlant}

/** Simulates a [[skein.vehicle.Plant]] or a [[skein.vehicle.SpatialPlant]] in many worlds with SIMD. Compiled
  * from the plant's own methods.
  */
private[skein] final class PlantLanes private (val plant: PlantTiming, form: PlantForm):
  def count: Int = form.count

  /** Whether commands and readings have a vertical part. */
  val inSpace: Boolean = plant.isInstanceOf[SpatialPlant[?]]

  /** The components of the plant's initial state; in space, at z = 0. */
  val initial: Array[Float] = initialAt(0)
  if initial.length != count then throw Untraceable(s"a state of $count doubles was expected")

  private def initialAt(downM: Double): Array[Float] =
    val state = plant match
      case spatial: SpatialPlant[?] => spatial.initial(downM)
      case level: Plant[?]          => level.initial
    PlantState.numbers(state).map(_.toFloat).toArray

  /** The horizontal reading of a vehicle at rest, relative to its start. */
  val resting: PlaneReading = plant match
    case spatial: SpatialPlant[?] => PlantLanes.levelOf(spatial)
    case level: Plant[?]          => readingOf(level)
  private def readingOf[S](plant: Plant[S]) = plant.read(plant.initial)

  /** Writes states at rest in space, at each world's altitude. */
  def restInSpace(array: Array[Float], from: Int, downM: Array[Float]): Unit =
    var initial = this.initial
    for world <- downM.indices do
      if world == 0 || downM(world) != downM(world - 1) then initial = initialAt(downM(world))
      for i <- 0 until count do array(from + i * downM.length + world) = initial(i)

  /** Writes the components of a state at rest, in all worlds. */
  def rest(array: Array[Float], from: Int): Unit =
    val worlds = LaneFunction.COUNT
    for i <- 0 until count do
      Arrays.fill(array, from + i * worlds, from + (i + 1) * worlds, initial(i))

  /** Writes one world's state at rest, if it depends on where the vehicle points. */
  def face(array: Array[Float], world: Int, headingRad: Double): Unit = plant match
    case car: DrivenCar =>
      val initial = PlantState.numbers(car.copy(startHeadingRad = headingRad).initial)
      for i <- initial.indices do array(i * LaneFunction.COUNT + world) = initial(i).toFloat
    case _ => ()

  /** The compiled step: inputs are the state's components, then the commanded velocity and the duration. */
  def step: FixedFormula = form.step.of(plant)

  /** The compiled reading, position and velocity: inputs are the state's components. */
  def read: FixedFormula = form.read.of(plant)

  def steps: PlantSteps = form.steps

  def stages: PlantStages = form.stages

  /** Compiled steps that begin at different times in each world. */
  def pieces: PlantPieces = form.pieces

/** The compiled code that plants of one form share. */
private final class PlantForm(plant: PlantTiming, stepping: Formula, reading: Formula):
  val count: Int = stepping.outputs.size
  if reading.inputs.size != count then throw Untraceable(s"a state of $count doubles was expected")

  private val inSpace = plant.isInstanceOf[SpatialPlant[?]]

  def fits(other: PlantTiming): Boolean = stepping.fits(other) && reading.fits(other)

  val stages: PlantStages = PlantStages(stepping, reading, inSpace)

  /** Lazy, because searches do not need these: their worlds share delays. */
  lazy val step: FixedFormula  = FixedFormula(stepping, plant)
  lazy val read: FixedFormula  = FixedFormula(reading, plant)
  lazy val steps: PlantSteps   = PlantSteps(stepping, reading, stages.places)
  lazy val pieces: PlantPieces = PlantPieces(stepping, reading, stages.places, inSpace)

private[skein] object PlantLanes:
  private def levelOf[S](plant: SpatialPlant[S]) =
    val seen = plant.read(plant.initial(0))
    PlaneReading(seen.northM, seen.eastM, seen.northMps, seen.eastMps)

  private val known = ConcurrentHashMap[Class[?], Forms[PlantTiming, PlantForm]]()

  /** Compiles a plant. Plants of one form share the compiled code.
    *
    * @return Left says why SIMD does not support such plants
    */
  def of(plant: PlantTiming): Either[String, PlantLanes] =
    val forms = known.computeIfAbsent(plant.getClass, _ => Forms[PlantTiming, PlantForm](_.fits(_))(traced))
    forms(plant)
      .flatMap: form =>
        try Right(PlantLanes(plant, form))
        catch case untraceable: Untraceable => Left(untraceable)
      .left
      .map(refused)

  private def traced(plant: PlantTiming) =
    for
      step <- Formula.of(plant, "step")
      read <- Formula.of(plant, "read")
    yield PlantForm(plant, step, read)

  private def refused(why: Untraceable) = s"the vehicle is no formula: ${why.getMessage}"
