package skein.lanes

import java.util.Arrays
import skein.formula.{Angles, Formula, Node, Trace, Untraceable}
import skein.forward.Duelist
import skein.vehicle.Plant

/** How a [[skein.vehicle.Plant]] flies in many worlds at once, compiled from its methods. */
private[lanes] final class PlantLanes private (val plant: Plant[?], stepping: Formula, reading: Formula):
  import PlantLanes.*

  /** How many numbers its state is. */
  val count: Int = stepping.outputs.size

  /** What it begins with. */
  val initial: Array[Float] = numbersOf(plant.initial).map(_.toFloat).toArray
  if initial.length != count || reading.inputs.size != count then
    throw Untraceable(s"a state of $count doubles was expected")

  /** Inputs are the state's numbers, then the commanded velocity and the time; [[First]] on, parameters. */
  private def bound(
      formula: Formula,
      leaf: (Trace, Int) => Node,
      made: (Trace, Vector[Node]) => Vector[Node]
  ) =
    val trace  = Trace()
    val angles =
      Angles(formula.trace, trace, leaf(trace, _), _ => None, number => trace.input(First + number))
    val outputs = made(trace, formula.outputs.map((_, node) => angles.convert(node)))
    val values  = formula.evaluate(angles.derived, Array.emptyDoubleArray, formula.parametersOf(plant))
    PlantFunction(BoundFunction.of(outputs), values.map(_.toFloat), count)

  /** The next state. */
  val step: PlantFunction = bound(stepping, _.input(_), (_, outputs) => outputs)

  /** Position and velocity; inputs behind the state are where it starts. */
  val read: PlantFunction = bound(
    reading,
    _.input(_),
    (trace, outputs) =>
      outputs.zipWithIndex.map((node, i) => if i < 2 then trace.add(node, trace.input(count + i)) else node)
  )

private[lanes] object PlantLanes:
  private val First = 1 << 20

  def of(plant: Plant[?]): Either[String, PlantLanes] =
    for
      step <- Formula.of(plant, "step").left.map(refused)
      read <- Formula.of(plant, "read").left.map(refused)
      made <-
        try Right(PlantLanes(plant, step, read))
        catch case untraceable: Untraceable => Left(refused(untraceable))
    yield made

  private def refused(why: Untraceable) = s"the vehicle is no formula: ${why.getMessage}"

  private def numbersOf(state: Any): Vector[Double] = state match
    case number: Double   => Vector(number)
    case several: Product => several.productIterator.flatMap(numbersOf).toVector
    case _                => Vector.empty

  /** A compiled method, and the numbers of its object. */
  final class PlantFunction(bound: BoundFunction, numbers: Array[Float], count: Int):
    def call: PlantCall = PlantCall(bound, numbers, count)

  /** Mutable. */
  final class PlantCall(bound: BoundFunction, numbers: Array[Float], count: Int):
    private val call = LaneCall(bound)
    for (input, place) <- bound.inputs.zipWithIndex if input >= First do
      call.input(place, Array.fill(TimetableVehicles.WORLDS)(numbers(input - First)), 0)

    /** @param others
      *   inputs behind the state
      * @param at
      *   where the outputs begin
      */
    def apply(
        state: Array[Array[Float]],
        others: Array[Array[Float]],
        outputs: Array[Array[Float]],
        at: Int
    ): Unit =
      var place = 0
      while place < bound.inputs.length do
        val input = bound.inputs(place)
        if input < count then call.input(place, state(input), 0)
        else if input < First then call.input(place, others(input - count), 0)
        place += 1
      var output = 0
      while output < bound.outputs do
        call.output(output, outputs(output), at)
        output += 1
      call()

/** Vehicles that move by a [[skein.vehicle.Plant]]. Their clock tells how many steps end before a moment, and how long it
  * is after the last of these. The scalar reference is `skein.forward.PlantVehicle`.
  */
private[lanes] final class TimetablePlants(duelist: Duelist, lanes: PlantLanes)
    extends TimetableVehicles(duelist):
  import TimetableVehicles.WORLDS
  private val step = lanes.step.call
  private val read = lanes.read.call

  private def states(): Array[Array[Float]] = Array.ofDim[Float](lanes.count, WORLDS)
  private var begun, next                   = states() // when the present step began, and what comes of it
  private val north, east, whole, rest      = Array.ofDim[Float](WORLDS)
  private val wholeStep                     = Array(north, east, whole)
  private val restOfStep                    = Array(north, east, rest)
  private val starts                        = Array(startX, startY)
  private val seen                          = Array.ofDim[Array[Float]](4)
  private val speed                         = duelist.speed.toFloat
  private var isCommanded                   = false
  Arrays.fill(whole, lanes.plant.stepS.toFloat)

  def start(worlds: Int): Unit =
    for i <- 0 until lanes.count do Arrays.fill(begun(i), lanes.initial(i))
    isCommanded = false
    seen(0) = seenX; seen(1) = seenY; seen(2) = seenVx; seen(3) = seenVy

  def rest(world: Int): Unit =
    for i <- 0 until lanes.count do
      begun(i)(world) = lanes.initial(i)
      next(i)(world) = lanes.initial(i)
    // Until its first command, where other worlds had theirs, it is told to stand still.
    north(world) = 0
    east(world) = 0

  def look(times: Array[Float], at: Int, into: Int, withVelocity: Boolean): Unit =
    fly(times, at)
    read(next, starts, seen, into)

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
        step(begun, wholeStep, next, 0)
        goOn()
      Arrays.fill(rest, times(at + 1))
      step(begun, restOfStep, next, 0)
    else for i <- begun.indices do System.arraycopy(begun(i), 0, next(i), 0, WORLDS)

  private def goOn(): Unit =
    val before = begun
    begun = next
    next = before
