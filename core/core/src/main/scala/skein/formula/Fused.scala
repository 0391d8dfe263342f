package skein.formula

import scala.collection.mutable
import skein.formula.Op.*

/** Rewrites expressions so that they need fewer operations on machines with a fused multiply-add. Results are
  * equal except for rounding.
  *
  *   - A product that is subtracted is added with one factor negated, if the negation costs nothing.
  *   - Division by a value that depends only on parameters becomes multiplication by its reciprocal.
  *   - An angle that is wrapped only beyond half a turn is always wrapped.
  */
private[skein] final class Fused(in: Trace, outputs: Vector[Node]):
  private val order = Trace.needed(outputs)
  private val fixed = mutable.HashSet.empty[Node]
  private val uses  = mutable.HashMap.empty[Node, Int].withDefaultValue(0)
  private val made  = mutable.HashMap.empty[Node, Node]

  /** The nodes that replace the outputs, in their order. */
  val nodes: Vector[Node] =
    for node <- order do
      if if node.args.isEmpty then node.op != Input else node.args.forall(fixed) then fixed += node
      for arg <- node.args do uses(arg) += 1
    for node <- order do made(node) = rewritten(node)
    outputs.map(made)

  private def rewritten(node: Node): Node =
    def a = node.args(0)
    def b = node.args(1)
    node.op match
      case Div if fixed(b) && !fixed(a)   => in.mul(made(a), in.div(in.const(1), made(b)))
      case Sub                            => difference(a, b)
      case Add if a.op == Neg             => in.sub(made(b), made(a.args(0)))
      case Add if b.op == Neg             => in.sub(made(a), made(b.args(0)))
      case Mul if a.op == Neg && fixed(b) => in.mul(made(a.args(0)), in.neg(made(b)))
      case Mul if b.op == Neg && fixed(a) => in.mul(in.neg(made(a)), made(b.args(0)))
      case Where if isWrapped(node)       => made(node.args(2))
      case _                              => in.again(node, node.args.map(made))

  private def difference(a: Node, b: Node): Node =
    val turned = if b.op == Mul then negated(b) else None
    turned match
      case Some(addend)                    => in.add(made(a), addend)
      case None if a.op == Mul && fixed(b) => in.add(made(a), in.neg(made(b)))
      case None                            => in.sub(made(a), made(b))

  /** The negated number, if the negation costs no operation. */
  private def negated(node: Node): Option[Node] =
    if fixed(node) then Some(in.neg(made(node)))
    else if uses(node) > 1 then None
    else
      node.op match
        case Neg => Some(made(node.args(0)))
        case Sub => Some(difference(node.args(1), node.args(0)))
        case Mul =>
          val Vector(a, b) = node.args
          negated(a).map(in.mul(_, made(b))).orElse(negated(b).map(in.mul(made(a), _)))
        case _ => None

  /** Whether a condition chooses between an angle, within half a turn, and the wrapped angle. */
  private def isWrapped(node: Node): Boolean =
    val Vector(condition, a, b) = node.args
    condition.op == Le && condition.args(0).op == Abs && condition.args(0).args(0) == a &&
    condition.args(1).is(math.Pi) && b.op == Remainder && b.args(0) == a && b.args(1).is(2 * math.Pi)
