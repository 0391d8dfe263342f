package skein.formula

import scala.collection.mutable
import skein.formula.Op.*

/** One number, or one condition, of an expression.
  *
  * @param value the value of a [[Op.Const]]
  * @param index which input or parameter an [[Op.Input]] or [[Op.Param]] is
  */
final class Node private[formula] (
    val id: Int,
    val op: Op,
    val args: Vector[Node],
    val value: Double,
    val index: Int
):
  def isConst: Boolean            = op == Const
  def is(number: Double): Boolean = isConst && value == number

  override def toString: String = op match
    case Const  => value.toString
    case Input  => s"in$index"
    case Param  => s"p$index"
    case Always => "true"
    case _      => args.mkString(s"$op(", ", ", ")")

/** A graph of expressions in which equal ones share a node, so that nothing is computed twice. Operations on
  * constants are evaluated immediately, bit-identical to a later evaluation; nothing is rearranged. A node's
  * arguments have smaller `id`s than the node. Not thread-safe.
  *
  * @param most maximum number of nodes; beyond it, tracing is refused
  */
final class Trace(most: Int = 200_000):
  private val known = mutable.HashMap.empty[Trace.Key, Node]
  private val all   = mutable.ArrayBuffer.empty[Node]

  def size: Int = all.size

  def const(value: Double): Node = leaf(Const, value, 0, java.lang.Double.doubleToRawLongBits(value))
  def input(index: Int): Node    = leaf(Input, 0, index, index)
  def param(index: Int): Node    = leaf(Param, 0, index, index)
  val always: Node               = leaf(Always, 0, 0, 0)

  def neg(a: Node): Node            = unary(Neg, a)
  def add(a: Node, b: Node): Node   = binary(Add, a, b)
  def sub(a: Node, b: Node): Node   = binary(Sub, a, b)
  def mul(a: Node, b: Node): Node   = binary(Mul, a, b)
  def div(a: Node, b: Node): Node   = binary(Div, a, b)
  def lt(a: Node, b: Node): Node    = comparison(Lt, a, b)
  def le(a: Node, b: Node): Node    = comparison(Le, a, b)
  def equal(a: Node, b: Node): Node = comparison(Eq, a, b)
  def never: Node                   = not(always)

  def unary(op: Op, a: Node): Node =
    if a.isConst then const(Op.compute(op, a.value))
    else if op == Neg && a.op == Neg then a.args(0)
    else node(op, a)

  def binary(op: Op, a: Node, b: Node): Node =
    if a.isConst && b.isConst then const(Op.compute(op, a.value, b.value))
    else
      op match
        case Mul if b.is(1)                    => a
        case Mul if a.is(1)                    => b
        case Div if b.is(1)                    => a
        case Mul if b.is(-1)                   => neg(a)
        case Mul if a.is(-1)                   => neg(b)
        case Sub if b.is(0) && 1 / b.value > 0 => a
        case Min | Max if isWithin(op, a, b)   => a
        case Mul if a.isConst && ofConsts(b)   => leaves(b)(mul(a, _))
        case Mul if b.isConst && ofConsts(a)   => leaves(a)(mul(_, b))
        case _                                 => node(op, a, b)

  private def comparison(op: Op, a: Node, b: Node): Node =
    if a.isConst && b.isConst then if Op.holds(op, a.value, b.value) then always else never
    else if op == Lt && a == b then never
    // A comparison of a value that a condition chose between known numbers is the condition itself, or its
    // negation.
    else if b.isConst && ofConsts(a) then chosen(a)(comparison(op, _, b))
    else if a.isConst && ofConsts(b) then chosen(b)(comparison(op, a, _))
    else node(op, a, b)

  def not(a: Node): Node =
    if a.op == Not then a.args(0) else node(Not, a)

  def and(a: Node, b: Node): Node =
    if a.op == Always then b
    else if b.op == Always || a == b then a
    else if isNever(a) || isNever(b) then never
    else node(And, a, b)

  def or(a: Node, b: Node): Node =
    if isNever(a) then b
    else if isNever(b) || a == b then a
    else if a.op == Always || b.op == Always then always
    else node(Or, a, b)

  def where(condition: Node, a: Node, b: Node): Node =
    if a == b || condition.op == Always then a
    else if isNever(condition) then b
    else if condition.op == Not then where(condition.args(0), b, a)
    // A nested choice by the same condition.
    else if a.op == Where && a.args(0) == condition then where(condition, a.args(1), b)
    else if b.op == Where && b.args(0) == condition then where(condition, a, b.args(2))
    else node(Where, condition, a, b)

  /** The operation of a node applied to other arguments. */
  def again(node: Node, args: Vector[Node]): Node = node.op match
    case Const | Always => import_(node)
    case Input          => input(node.index)
    case Param          => param(node.index)
    case Where          => where(args(0), args(1), args(2))
    case Not            => not(args(0))
    case And            => and(args(0), args(1))
    case Or             => or(args(0), args(1))
    case Lt | Le | Eq   => comparison(node.op, args(0), args(1))
    case op             => if args.size == 1 then unary(op, args(0)) else binary(op, args(0), args(1))

  private def import_(node: Node): Node = if node.op == Const then const(node.value) else always

  private def isNever(a: Node) = a.op == Not && a.args(0).op == Always

  /** Whether its value is chosen among few constants, such as the nearest of all vehicles. */
  private def ofConsts(a: Node): Boolean = a.op == Where && withoutConsts(a, Trace.MostChosen) >= 0

  /** `most`, less the number of constants among which a value is chosen; negative if there are more, or if it
    * is not chosen among constants.
    */
  private def withoutConsts(a: Node, most: Int): Int =
    if most < 0 || a.isConst then most - 1
    else if a.op == Where then withoutConsts(a.args(2), withoutConsts(a.args(1), most))
    else -1

  /** Whether a limit changes nothing, because the number is NaN or has such a limit already. */
  private def isWithin(op: Op, a: Node, limit: Node, most: Int = Trace.MostLimits): Boolean =
    def within(arg: Node) = isWithin(op, arg, limit, most - 1)
    most > 0 && limit.isConst && (a.op match
      case Const     => Op.compute(op, a.value, limit.value).equals(a.value)
      case `op`      => a.args.exists(within)
      case Min | Max => a.args.forall(within)
      case Where     => within(a.args(1)) && within(a.args(2))
      case _         => false)

  private def leaves(a: Node)(change: Node => Node): Node =
    if a.op == Where then where(a.args(0), leaves(a.args(1))(change), leaves(a.args(2))(change))
    else change(a)

  private def chosen(a: Node)(holds: Node => Node): Node =
    if a.op != Where then holds(a)
    else
      val (yes, no) = (chosen(a.args(1))(holds), chosen(a.args(2))(holds))
      if yes == no then yes
      else or(and(a.args(0), yes), and(not(a.args(0)), no))

  private def node(op: Op, args: Node*): Node =
    def id(argument: Int) = if argument < args.size then args(argument).id.toLong else -1L
    val key               = Trace.Key(op.ordinal, id(0) << 32 | id(1) & 0xffffffffL, id(2))
    known.getOrElseUpdate(key, make(op, args.toVector, 0, 0))

  private def leaf(op: Op, value: Double, index: Int, key: Long): Node =
    known.getOrElseUpdate(Trace.Key(op.ordinal, key, -1), make(op, Vector.empty, value, index))

  private def make(op: Op, args: Vector[Node], value: Double, index: Int): Node =
    if all.size >= most then throw Untraceable(s"it comes to more than $most operations")
    val made = Node(all.size, op, args, value, index)
    all += made
    made

object Trace:
  private val MostChosen = 64

  /** Maximum depth of the operations that are searched for a limit. */
  private val MostLimits = 6

  /** Identifies equal nodes: their operation, and the numbers of their arguments or of themselves. */
  private final case class Key(op: Int, first: Long, rest: Long):
    override def hashCode: Int =
      val mixed = (first * 31 + rest) * 0x9e3779b97f4a7c15L + op
      (mixed ^ mixed >>> 32).toInt

  /** The nodes that these depend on, each once, arguments first, in depth-first postorder. */
  def needed(of: Seq[Node]): Vector[Node] =
    val seen  = mutable.HashSet.empty[Int]
    val order = Vector.newBuilder[Node]
    // Expressions may be deeper than a thread's stack: nodes with the number of their arguments that were
    // visited.
    val walk = mutable.Stack.empty[(Node, Int)]
    for node <- of if seen.add(node.id) do
      walk.push((node, 0))
      while walk.nonEmpty do
        val (one, gone) = walk.pop()
        if gone == one.args.size then order += one
        else
          walk.push((one, gone + 1))
          val next = one.args(gone)
          if seen.add(next.id) then walk.push((next, 0))
    order.result()

  /** Copies expressions into another trace, with some nodes substituted. */
  def replaced(of: Vector[Node], in: Trace)(by: Node => Option[Node]): Vector[Node] =
    val made = mutable.HashMap.empty[Node, Node]
    for node <- needed(of) do made(node) = by(node).getOrElse(in.again(node, node.args.map(made)))
    of.map(made)

  /** The largest subexpressions of these that depend only on constants and the known leaves. Computed ahead,
    * once those leaves are known, they leave the least work for later.
    */
  def earliest(of: Vector[Node])(isKnown: Node => Boolean): Vector[Node] =
    val order        = needed(of)
    val fixed, known = mutable.HashSet.empty[Node]
    for node <- order do
      if if node.args.isEmpty then node.op != Input else node.args.forall(fixed) then fixed += node
      else if isKnown(node) || node.args.nonEmpty && node.args.forall(arg => fixed(arg) || known(arg)) then
        known += node
    val usedLate = mutable.HashSet.from(of)
    // Conditions are not numbers: what they compare is.
    for node <- order.reverseIterator if usedLate(node) && (!known(node) || node.op.isCondition) do
      usedLate ++= node.args
    order.filter(node => known(node) && usedLate(node) && !node.op.isCondition)

  /** Of a node's dependencies, those at every 256th level, the lowest first. A memoising recursion that
    * visits these first stays within a thread's stack.
    */
  def landings(of: Node): Vector[Node] =
    val level = mutable.HashMap.empty[Int, Int]
    needed(Seq(of)).filter: node =>
      val own = node.args.iterator.map(arg => level(arg.id)).maxOption.fold(0)(_ + 1)
      level(node.id) = own
      own > 0 && own % 256 == 0
