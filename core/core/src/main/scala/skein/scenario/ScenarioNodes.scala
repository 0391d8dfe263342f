package skein.scenario

import java.util.Locale
import scala.collection.mutable
import skein.formula.{Node, Op, Trace}
import skein.policy.PolicyInput

/** The nodes of a [[ScenarioFile]], each defined by a line such as `7 add 3 5`. Their numbers are
  * consecutive, and arguments have smaller numbers.
  */
private[scenario] final class ScenarioNodes extends ScenarioNumbers:
  import ScenarioMistake.*
  import ScenarioNodes.*

  private val trace      = Trace(MostOperations)
  private val all        = mutable.ArrayBuffer.empty[Node]
  private val conditions = mutable.BitSet.empty
  private val depths     = mutable.HashMap.empty[Node, Int]
  private val inputs     = mutable.LinkedHashMap.empty[Leaf, Int]
  private val observing  = mutable.HashSet.empty[Node]

  def size: Int                     = all.size
  def apply(id: Int): Node          = all(id)
  def isCondition(id: Int): Boolean = conditions(id)

  def reads(node: Node): Boolean = observing(node)

  /** Adds the node of a line.
    *
    * @param setting index of a setting, from its name; −1 if there is no such setting
    */
  def add(number: String, words: ScenarioWords, setting: String => Int): Unit =
    if number != size.toString then wrong(s"expected node $size, the next one, got '${shown(number)}'")
    if size >= MostNodes then wrong(s"expected at most $MostNodes nodes, got more")
    val word    = words.text("an operation")
    val node    = leaf(word, words, setting).getOrElse(computed(word, words))
    val isTruth = ofTruth(word)
    if isTruth then conditions += size
    all += node
    if depth(node) > MostDepth then
      wrong(s"expected at most $MostDepth operations upon one another, got more")

  /** Length of the longest chain of operations that leads to a node. Also records which nodes depend on
    * inputs. A line adds few nodes, so the recursion is not deep.
    */
  private def depth(node: Node): Int = depths.get(node) match
    case Some(known) => known
    case None        =>
      val own = node.args.map(depth).maxOption.fold(0)(_ + 1)
      depths(node) = own
      if node.op == Op.Input || node.args.exists(observing) then observing += node
      own

  private def leaf(word: String, words: ScenarioWords, setting: String => Int): Option[Node] =
    def vehicle = words.whole("a vehicle", MostVehicles)
    word match
      case "const"   => Some(trace.const(words.number("a constant", each => !each.isNaN)))
      case "setting" =>
        val name = words.key("a setting")
        setting(name) match
          case -1    => wrong(s"expected a setting of an earlier line, got '$name'")
          case index => Some(trace.param(index))
      case "memory" => Some(input(PolicyInput.Memory(words.whole("a number of the memory", MostMemory))))
      case "ahead"  => Some(input(Ahead))
      case _        =>
        OfVehicle
          .get(word)
          .map(of => input(of(vehicle)))
          .orElse(Alone.get(word).map(input))

  private def input(leaf: Leaf): Node = trace.input(inputs.getOrElseUpdate(leaf, inputs.size))

  private def computed(word: String, words: ScenarioWords): Node =
    val op = Operations.getOrElse(
      word,
      wrong(s"expected an operation, such as add, got '${shown(word)}'")
    )
    op match
      case Op.Always           => trace.always
      case Op.Not              => trace.not(words.condition())
      case Op.And              => trace.and(words.condition(), words.condition())
      case Op.Or               => trace.or(words.condition(), words.condition())
      case Op.Where            => trace.where(words.condition(), words.value(), words.value())
      case Op.Lt               => trace.lt(words.value(), words.value())
      case Op.Le               => trace.le(words.value(), words.value())
      case Op.Eq               => trace.equal(words.value(), words.value())
      case one if isUnary(one) => trace.unary(one, words.value())
      case two                 => trace.binary(two, words.value(), words.value())

  def inputsOf(of: Seq[Node]): Vector[Leaf] =
    val leaves = inputs.keysIterator.toVector
    Trace.needed(of).filter(_.op == Op.Input).map(node => leaves(node.index)).distinct

  /** Copies nodes into a new trace, with inputs in another order. */
  def moved(of: Vector[Node], order: Vector[Leaf]): (Trace, Vector[Node]) =
    val leaves = inputs.keysIterator.toVector
    val places = order.zipWithIndex.toMap
    val own    = Trace(MostOperations)
    (
      own,
      Trace.replaced(of, own)(node => Option.when(node.op == Op.Input)(own.input(places(leaves(node.index)))))
    )

private[scenario] object ScenarioNodes:
  /** An input that only goals have: the time ahead, s. */
  case object Ahead

  type Leaf = PolicyInput | Ahead.type

  val MostVehicles = 100
  val MostMemory   = 1024

  private val MostNodes      = 120_000
  private val MostOperations = 120_000
  private val MostDepth      = 5_000

  private val OfVehicle: Map[String, Int => PolicyInput] = Map(
    "north"     -> (PolicyInput.Position(_, 0)),
    "east"      -> (PolicyInput.Position(_, 1)),
    "down"      -> (PolicyInput.Position(_, 2)),
    "north-mps" -> (PolicyInput.Velocity(_, 0)),
    "east-mps"  -> (PolicyInput.Velocity(_, 1)),
    "down-mps"  -> (PolicyInput.Velocity(_, 2)),
    "heading"   -> (PolicyInput.Heading(_)),
    "age"       -> (PolicyInput.Age(_))
  )

  private val Alone: Map[String, PolicyInput] = Map(
    "elapsed"    -> PolicyInput.Elapsed,
    "acts-in"    -> PolicyInput.ActsIn,
    "time"       -> PolicyInput.Time,
    "cruise"     -> PolicyInput.Cruise,
    "start-down" -> PolicyInput.StartDown
  )

  private val Operations: Map[String, Op] =
    Op.values.filterNot(Set(Op.Const, Op.Input, Op.Param)).map(op =>
      op.toString.toLowerCase(Locale.ROOT) -> op
    ).toMap

  private def ofTruth(word: String) = Operations.get(word).exists(_.isCondition)

  private def isUnary(op: Op) = op.ordinal >= Op.Neg.ordinal && op.ordinal <= Op.Signum.ordinal
