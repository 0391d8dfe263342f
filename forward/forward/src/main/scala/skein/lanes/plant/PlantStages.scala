package skein.lanes.plant

import scala.collection.mutable
import skein.formula.{Evaluation, Formula, Node, Op, Trace}
import skein.simd.BoundFunction
import skein.vehicle.Plant

/** A plant's step, cut by when its numbers are known, for worlds whose steps begin and end together. What
  * comes of the state and the command alone is computed as a step begins and kept; what comes of the time
  * alone is the same in all worlds, and told; only the rest is computed at each moment. Compiled once for all
  * plants of a form.
  *
  * Parameters of all functions are the speed of a command of length 1, then the plant's own numbers, then
  * those of the time.
  */
private[lanes] final class PlantStages(stepping: Formula, reading: Formula):
  import PlantStages.*

  private val trace       = Trace()
  private val count       = stepping.outputs.size
  private val expressions = PlantExpressions(
    trace,
    stepping,
    reading,
    first = 0,
    number => trace.input(State + number),
    trace.input(North),
    trace.input(East),
    trace.input(Time)
  )
  import expressions.{seen, stepped}

  /** The state's numbers that are where the vehicle is, north and east, if nothing else comes of them. They
    * begin where it starts, then; otherwise the start is added to what is seen.
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
          node.op == Op.Add
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

  /** What comes of some inputs alone, and the rest of these expressions, by it. */
  private def cut(of: Vector[Node], isKnown: Node => Boolean, by: Int => Node): (Vector[Node], Vector[Node]) =
    val early = Trace.earliest(of)(node => node.op == Op.Input && isKnown(node))
    val place = early.zipWithIndex.toMap
    (early, Trace.replaced(of, trace)(place.get(_).map(by)))

  private val command = Vector(trace.input(North), trace.input(East))

  /** What comes of the command alone, by where it is kept: it stays if the next step comes of itself. */
  private val staying: Map[Node, Node] =
    ofState.zipWithIndex
      .filter((node, _) =>
        Trace.needed(Seq(node)).forall(each => each.op != Op.Input || command.contains(each))
      )
      .map((node, i) => node -> trace.input(Kept + i))
      .toMap

  /** So does the command itself, if more comes of it. */
  private val keeps =
    val again = Trace.replaced(ofState, trace)(staying.get)
    ofState ++ (if Trace.needed(again).exists(command.contains) then command else Vector.empty)

  /** How many numbers are kept. */
  val kept: Int = keeps.size

  /** How many numbers tell a time. */
  val times: Int = ofTime.size

  /** What is kept, of the state, the command and, if what is kept tells the position, the start. */
  val begin: BoundFunction =
    val states = places.toVector.flatten.map(number => trace.input(State + number))
    keeping(Trace.replaced(keeps, trace): node =>
      Option.when(states.contains(node))(trace.add(node, trace.input(StartX + states.indexOf(node)))))

  /** What is kept of the next step, of what is kept of this one, its time and a new command. */
  val act: BoundFunction = next(Map.empty)

  /** The same under the same command. */
  val goOn: BoundFunction =
    next(command.zipWithIndex.map((node, i) => node -> trace.input(Kept + ofState.size + i)).toMap ++ staying)

  /** @param known what is kept already
    */
  private def next(known: Map[Node, Node]) = keeping(Trace.replaced(keeps, trace)(node =>
    known
      .get(node)
      .orElse(Option.when(node.op == Op.Input && node.index >= State)(late(node.index - State)))
  ))

  /** Whether what is kept of the next step may take the place of what is kept of this one. */
  def isKeptInPlace: Boolean = act.function.isOnePass && goOn.function.isOnePass

  private def keeping(of: Vector[Node]) = BoundFunction.of(of, rowOf, areRows = true)

  /** Position, of what is kept, the time and, unless it is kept, the start. */
  val position: BoundFunction = BoundFunction.of(late.slice(count, count + 2), rowOf)

  /** Position and velocity, of the same. */
  val look: BoundFunction = BoundFunction.of(late.drop(count), rowOf)

  /** The state's numbers, of the same. */
  lazy val end: BoundFunction = BoundFunction.of(late.take(count), rowOf, areRows = true)

  /** The functions' parameters, but for the time. */
  def parametersOf(plant: Plant[?], speedMps: Double): Array[Float] =
    expressions.parametersOf(plant, speedMps).map(_.toFloat) ++ Array.ofDim[Float](times)

  /** Where the time's begin. */
  def firstOfTime: Int = expressions.parameters

  /** Tells times by the numbers that come of them. */
  def tell(plant: Plant[?]): Double => Array[Double] =
    val own = expressions.parametersOf(plant, 0)
    dtS => timesOf(Array(dtS), own)

private[lanes] object PlantStages:
  /** What the expressions' inputs are: the time, the command over the speed, where it starts, the state's
    * numbers, what is kept.
    */
  val Time: Int   = 0
  val StartX: Int = 1
  val StartY: Int = 2
  val North: Int  = 3
  val East: Int   = 4
  val State: Int  = 5
  val Kept: Int   = 1 << 16

  /** The state's numbers stand in one array, and so does what is kept. */
  private val rowOf: PartialFunction[Int, Int] =
    case kept if kept >= Kept    => kept - Kept
    case state if state >= State => state - State
