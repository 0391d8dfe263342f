package skein.lanes

import java.util.Arrays
import skein.formula.{Formula, Untraceable}
import skein.vehicle.{PlaneReading, Plant}

/** How a [[skein.vehicle.Plant]] flies in many worlds at once, compiled from its methods. */
private[skein] final class PlantLanes private (val plant: Plant[?], stepping: Formula, reading: Formula):
  import PlantLanes.*

  /** How many numbers its state is. */
  val count: Int = stepping.outputs.size

  /** What it begins with. */
  val initial: Array[Float] = numbersOf(plant.initial).map(_.toFloat).toArray
  if initial.length != count || reading.inputs.size != count then
    throw Untraceable(s"a state of $count doubles was expected")

  val resting: PlaneReading                 = readingOf(plant)
  private def readingOf[S](plant: Plant[S]) = plant.read(plant.initial)

  /** Its step in parts. */
  lazy val stages: PlantStages = PlantStages(stepping, reading)

  /** Fills in the numbers of a state at rest, of all worlds. */
  def rest(array: Array[Float], from: Int): Unit =
    val worlds = TimetableVehicles.WORLDS
    for i <- 0 until count do
      Arrays.fill(array, from + i * worlds, from + (i + 1) * worlds, initial(i))

  /** The next state: of the state's numbers, then the commanded velocity and the time. */
  val step: FixedFormula = FixedFormula(stepping, plant)

  /** Position and velocity: of the state's numbers, then where it starts. */
  val read: FixedFormula = FixedFormula(
    reading,
    plant,
    extra = 2,
    changed = (trace, outputs) =>
      outputs.zipWithIndex.map((node, i) => if i < 2 then trace.add(node, trace.input(count + i)) else node)
  )

private[skein] object PlantLanes:
  def of(plant: Plant[?]): Either[String, PlantLanes] =
    for
      step <- Formula.of(plant, "step").left.map(refused)
      read <- Formula.of(plant, "read").left.map(refused)
      made <-
        try Right(PlantLanes(plant, step, read))
        catch case untraceable: Untraceable => Left(refused(untraceable))
    yield made

  private def refused(why: Untraceable) = s"the vehicle is no formula: ${why.getMessage}"

  /** A state's numbers in their order. */
  def numbersOf(state: Any): Vector[Double] = state match
    case number: Double   => Vector(number)
    case several: Product => several.productIterator.flatMap(numbersOf).toVector
    case _                => Vector.empty
