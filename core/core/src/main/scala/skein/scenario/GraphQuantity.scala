package skein.scenario

import skein.formula.{Evaluation, Formula, KnownFormula, Node, Trace}

/** A quantity that is data, for example one traced in Python.
  *
  * @param trace with inputs for north of all vehicles, then east, then down, then the time
  */
private[scenario] final class QuantityGraph(
    trace: Trace,
    value: Node,
    vehicles: Int,
    settings: Vector[String]
):
  private val evaluation = Evaluation(Vector(value))

  def apply(at: Positions, values: Array[Double]): Double =
    val places = Seq(at.northM, at.eastM, at.downM).flatMap(_.take(vehicles))
    evaluation((places :+ at.elapsedS).toArray, values)(0)

  val formula: Formula = Formula.ofGraph(
    trace,
    Seq("north", "east", "down").toVector.flatMap(axis =>
      (0 until vehicles).map(at => s"$axis($at)")
    ) :+ "elapsed",
    Vector("answer" -> value),
    settings
  ) {
    case same: GraphQuantity => same.graph eq this
    case _                   => false
  } {
    case same: GraphQuantity => same.values
    case _                   => Array.emptyDoubleArray
  }

/** A [[QuantityGraph]] with values of its settings. */
private[skein] final class GraphQuantity private[scenario] (
    private[scenario] val graph: QuantityGraph,
    private[scenario] val values: Array[Double]
) extends Quantity, KnownFormula:
  def of(positions: Positions): Double = graph(positions, values)

  def formula: Formula = graph.formula
