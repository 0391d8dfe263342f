package skein.simd

import skein.formula.{Node, Op, Trace}

/** Determines which products in expressions are fused with sums, and which are computed by themselves. */
private[skein] final class Products(outputs: Vector[Node]):
  private val order = Trace.needed(outputs)

  private val fused: Set[Node] =
    order.iterator.filter(_.op == Op.Add).flatMap(Products.factor).toSet

  private val usedPlainly: Set[Node] = order.iterator
    .flatMap(node => node.args.filterNot(arg => Products.factor(node).contains(arg)))
    .toSet ++ outputs

  private def isFusedAlone(node: Node) = node.op == Op.Mul && fused(node) && !usedPlainly(node)

  /** All nodes to compute, arguments before their users. */
  val computed: Vector[Node] = order.filterNot(isFusedAlone)

  def argsOf(node: Node): Vector[Node] =
    node.args.flatMap(arg => if isFusedAlone(arg) then arg.args else Vector(arg))

private[skein] object Products:
  /** The product that is fused with a sum, if any. */
  def factor(sum: Node): Option[Node] =
    if sum.op == Op.Add then sum.args.find(_.op == Op.Mul) else None
