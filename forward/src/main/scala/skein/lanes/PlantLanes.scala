package skein.lanes

import java.util.Arrays
import skein.formula.{Formula, Untraceable}
import skein.forward.Duelist
import skein.vehicle.Plant

/** How a [[skein.vehicle.Plant]] flies in many worlds at once, compiled from its methods. */
private[skein] final class PlantLanes private (val plant: Plant[?], stepping: Formula, reading: Formula):
  import PlantLanes.*

  /** How many numbers its state is. */
  val count: Int = stepping.outputs.size

  /** What it begins with. */
  val initial: Array[Float] = numbersOf(plant.initial).map(_.toFloat).toArray
  if initial.length != count || reading.inputs.size != count then
    throw Untraceable(s"a state of $count doubles was expected")

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

/** Vehicles that move by a [[skein.vehicle.Plant]]. Their clock tells how many steps end before a moment, and
  * how long it is after the last of these. The scalar reference is `skein.forward.PlantVehicle`.
  */
private[lanes] final class TimetablePlants(duelist: Duelist, lanes: PlantLanes)
    extends TimetableVehicles(duelist):
  import TimetableVehicles.WORLDS
  private val step = lanes.step.call
  private val read = lanes.read.call

  private var begun, next =
    Array.ofDim[Float](lanes.count * WORLDS) // when the present step began, and what comes of it
  private val north, east, whole, rest = Array.ofDim[Float](WORLDS)
  private val speed                    = duelist.speed.toFloat
  private var isCommanded              = false
  Arrays.fill(whole, lanes.plant.stepS.toFloat)
  step.input(lanes.count, north, 0)
  step.input(lanes.count + 1, east, 0)
  read.input(lanes.count, startX, 0)
  read.input(lanes.count + 1, startY, 0)

  def start(worlds: Int): Unit =
    lanes.rest(begun, 0)
    isCommanded = false

  def rest(world: Int): Unit =
    for i <- 0 until lanes.count do
      begun(i * WORLDS + world) = lanes.initial(i)
      next(i * WORLDS + world) = lanes.initial(i)
    // Until its first command, where other worlds had theirs, it is told to stand still.
    north(world) = 0
    east(world) = 0

  def look(times: Array[Float], at: Int, into: Int, withVelocity: Boolean): Unit =
    fly(times, at)
    read.inputs(0, lanes.count, next, 0)
    read.output(0, seenX, into)
    read.output(1, seenY, into)
    read.output(2, seenVx, into)
    read.output(3, seenVy, into)
    read()

  def act(times: Array[Float], at: Int, commanded: Directions, from: Int): Unit =
    fly(times, at)
    goOn()
    isCommanded = true
    var world = 0
    while world < WORLDS do
      north(world) = commanded.cos(from + world) * speed
      east(world) = commanded.sin(from + world) * speed
      world += 1

  /** To a moment, from the beginning of a step. */
  private def fly(times: Array[Float], at: Int): Unit =
    if isCommanded then
      for _ <- 1 to times(at).toInt do
        fly(whole)
        goOn()
      Arrays.fill(rest, times(at + 1))
      fly(rest)
    else System.arraycopy(begun, 0, next, 0, begun.length)

  private def fly(forS: Array[Float]): Unit =
    step.inputs(0, lanes.count, begun, 0)
    step.input(lanes.count + 2, forS, 0)
    step.outputs(lanes.count, next, 0)
    step()

  private def goOn(): Unit =
    val before = begun
    begun = next
    next = before
