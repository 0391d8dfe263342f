package skein.lanes.plant

import scala.collection.mutable
import skein.formula.{Evaluation, Formula, Node, Op, Trace}
import skein.simd.BoundFunction
import skein.vehicle.PlantTiming

/** A plant's step in stages, for worlds whose steps begin and end together. Values that depend only on the
  * state and the command are computed at the start of a step and stored. Values that depend only on the time
  * are equal in all worlds and passed in. Only the remaining values are computed at each moment. Compiled
  * once for all plants of a form.
  *
  * The parameters of all functions are the speed of a command of length 1, then the plant's own parameters,
  * then the values of the time.
  */
private[lanes] final class PlantStages(stepping: Formula, reading: Formula, inSpace: Boolean):
  import PlantStages.*

  private val trace       = Trace()
  private val count       = stepping.outputs.size
  private val vertical    = if inSpace then Vector(trace.input(Third), trace.input(Holds)) else Vector.empty
  private val expressions = PlantExpressions(
    trace,
    stepping,
    reading,
    first = 0,
    number => trace.input(State + number),
    trace.input(North),
    trace.input(East),
    trace.input(Time),
    vertical
  )
  import expressions.{seen, stepped}

  /** Indices of the state's components that equal the vehicle's position, north and east, if no other
    * component depends on them. These components then begin at the vehicle's start; otherwise the start is
    * added to the readings.
    */
  val places: Option[Vector[Int]] =
    val found = Vector(0, 1).flatMap(placeOf)
    Option.when(found.size == 2)(found)

  private def placeOf(axis: Int): Option[Int] =
    val order = Trace.needed(stepped ++ seen)
    stepped.indices.find: number =>
      val moved               = mutable.HashSet(trace.input(State + number))
      def isAdded(node: Node) = node.args.count(moved) match
        case 0 => true
        case 1 =>
          moved += node
          node.op == Op.Add || node.op == Op.Sub && moved(node.args(0))
        case _ => false
      def moves(outputs: Vector[Node]) = outputs.indices.filter(i => moved(outputs(i)))
      order.forall(isAdded) && moves(stepped) == Seq(number) && moves(seen) == Seq(axis)

  private val located =
    if places.isDefined then seen else expressions.seenFrom(trace.input(StartX), trace.input(StartY))
  private val (ofState, timed) =
    cut(
      stepped ++ located,
      _.index >= North,
      i => trace.input(Kept + i)
    )
  private val (ofTime, late) = cut(timed, _.index == Time, i => trace.param(firstOfTime + i))
  private val timesOf        = Evaluation(ofTime)

  /** Splits expressions into the subexpressions that depend only on some inputs, and the rest. */
  private def cut(of: Vector[Node], isKnown: Node => Boolean, by: Int => Node): (Vector[Node], Vector[Node]) =
    val early = Trace.earliest(of)(node => node.op == Op.Input && isKnown(node))
    val place = early.zipWithIndex.toMap
    (early, Trace.replaced(of, trace)(place.get(_).map(by)))

  private val command = Vector(trace.input(North), trace.input(East)) ++ vertical

  /** Stored values that depend only on the command, and so stay valid if the next step has no new command. */
  private val staying: Map[Node, Node] =
    ofState.zipWithIndex
      .filter((node, _) =>
        Trace.needed(Seq(node)).forall(each => each.op != Op.Input || command.contains(each))
      )
      .map((node, i) => node -> trace.input(Kept + i))
      .toMap

  /** Stored values that a later step would otherwise compute from only the command, at some cost. */
  private val ofCommand =
    Trace.earliest(ofState)(command.contains).filter(node => node.op.isDear && !ofState.contains(node))

  /** The stored values, including the command itself if a later step needs it. */
  private val keeps =
    val known = staying ++ ofCommand.map(node => node -> trace.const(0))
    val again = Trace.replaced(ofState, trace)(known.get)
    val whole = if Trace.needed(again).exists(command.contains) then command else Vector.empty
    ofState ++ ofCommand ++ whole

  val kept: Int = keeps.size

  /** Number of values that represent a time in a call. */
  val times: Int = ofTime.size

  /** Computes the stored values from the state, the command and, if they contain the position, the start. */
  val begin: BoundFunction =
    val states = places.toVector.flatten.map(number => trace.input(State + number))
    keeping(Trace.replaced(keeps, trace): node =>
      Option.when(states.contains(node))(trace.add(node, trace.input(StartX + states.indexOf(node)))))

  /** Computes the next step's stored values from those of this step, its duration and a new command. */
  val act: BoundFunction = next(Map.empty)

  /** Computes the next step's stored values under the present command; see [[act]]. */
  val goOn: BoundFunction =
    val stored = keeps.zipWithIndex.drop(ofState.size).map((node, i) => node -> trace.input(Kept + i))
    next(staying ++ stored)

  private def next(known: Map[Node, Node]) = keeping(Trace.replaced(keeps, trace)(node =>
    known
      .get(node)
      .orElse(Option.when(node.op == Op.Input && node.index >= State)(late(node.index - State)))
  ))

  /** Whether the next step's stored values may overwrite those of this step. */
  def isKeptInPlace: Boolean = act.function.isOnePass && goOn.function.isOnePass

  private def keeping(of: Vector[Node]) = BoundFunction.of(of, rowOf, areRows = true)

  /** Computes the position from the stored values, the time and, unless they contain it, the start. */
  val position: BoundFunction = BoundFunction.of(late.slice(count, count + 2), rowOf)

  /** Computes position and velocity, from the inputs of [[position]]. */
  val look: BoundFunction = BoundFunction.of(late.drop(count), rowOf)

  /** Computes the state, from the inputs of [[position]]. */
  lazy val end: BoundFunction = BoundFunction.of(late.take(count), rowOf, areRows = true)

  /** The parameters of all functions; those of the time are 0. */
  def parametersOf(plant: PlantTiming, speedMps: Double): Array[Float] =
    expressions.parametersOf(plant, speedMps).map(_.toFloat) ++ Array.ofDim[Float](times)

  def firstOfTime: Int = expressions.parameters

  /** Converts a time, s, to the values that represent it. */
  def tell(plant: PlantTiming): Double => Array[Double] =
    val own = expressions.parametersOf(plant, 0)
    dtS => timesOf(Array(dtS), own)

private[lanes] object PlantStages:
  /** Inputs of the expressions: the time, the start, the command divided by the speed with its vertical part,
    * the state's components, and the stored values.
    */
  val Time: Int   = 0
  val StartX: Int = 1
  val StartY: Int = 2
  val North: Int  = 3
  val East: Int   = 4
  val Third: Int  = 5
  val Holds: Int  = 6
  val State: Int  = 7
  val Kept: Int   = 1 << 16

  /** Rows of inputs: the state's components share one array, and so do the stored values. */
  private val rowOf: PartialFunction[Int, Int] =
    case kept if kept >= Kept    => kept - Kept
    case state if state >= State => state - State
