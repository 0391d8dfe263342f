package skein.formula

/** Evaluates nodes of one [[Trace]] repeatedly. The order of evaluation is computed only once. */
final class Evaluation(nodes: Vector[Node]):
  private val order   = Trace.needed(nodes).toArray
  private val size    = order.iterator.map(_.id + 1).maxOption.getOrElse(0)
  private val answers = nodes.iterator.map(_.id).toArray

  def apply(input: Array[Double], parameters: Array[Double]): Array[Double] =
    val values = Array.ofDim[Double](size)
    Evaluation.compute(order, input, parameters, values)
    answers.map(values(_))

object Evaluation:
  /** Writes the values of nodes by number. Arguments must precede their users in the order; conditions have
    * the values 1 and 0.
    */
  private[formula] def compute(
      order: Array[Node],
      input: Array[Double],
      parameters: Array[Double],
      values: Array[Double]
  ): Unit =
    import Op.{Always, And, Const, Eq, Input, Le, Lt, Not, Or, Param, Where}
    for node <- order do
      def a = values(node.args(0).id)
      def b = values(node.args(1).id)
      values(node.id) = node.op match
        case Const        => node.value
        case Input        => input(node.index)
        case Param        => parameters(node.index)
        case Where        => if a != 0 then b else values(node.args(2).id)
        case Always       => 1
        case Not          => 1 - a
        case And          => Math.min(a, b)
        case Or           => Math.max(a, b)
        case Lt | Le | Eq => if Op.holds(node.op, a, b) then 1 else 0
        case op           => if node.args.size == 1 then Op.compute(op, a) else Op.compute(op, a, b)
