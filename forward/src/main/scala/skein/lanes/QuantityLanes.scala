package skein.lanes

import java.util.concurrent.CopyOnWriteArrayList
import skein.formula.{Angles, Formula, Node, Trace, Untraceable}
import skein.scenario.{Positions, Quantity}

/** How quantities are computed in many worlds at once, compiled from their methods [[Quantity.of]]: several of one
  * view, together. Quantities of one form differ in numbers alone.
  */
private[lanes] final class QuantityLanes private (formulas: Vector[Formula], val count: Int):
  import QuantityLanes.*

  private val trace = Trace()

  private val angles: Vector[Angles] = formulas.zipWithIndex.map: (formula, number) =>
    Angles(
      formula.trace,
      trace,
      trace.input,
      _ => None,
      parameter => trace.input(FirstParameter + number * Stride + parameter)
    )

  private val values: Vector[Node] =
    formulas.indices.toVector.map(number => angles(number).convert(formulas(number).outputs(0)._2))

  private val derived = angles.map(_.derived)

  val function: BoundFunction = BoundFunction.of(values)

  /** A vehicle and what of its reading an input is: position north and east, by 0 and 1. */
  def reading(input: Int): Option[(Int, Int)] =
    Option.when(input < 2 * count)((input % count, input / count))

  /** The vehicle whose altitude an input is. */
  def altitudeOf(input: Int): Option[Int] =
    Option.when(input >= 2 * count && input < FirstParameter)(input - 2 * count)

  /** The quantity and the number of the parameter that another input is. */
  def parameterOf(input: Int): (Int, Int) =
    ((input - FirstParameter) / Stride, (input - FirstParameter) % Stride)

  def parameters(number: Int): Int = derived(number).size

  def parametersOf(number: Int, quantity: Quantity): Array[Double] =
    val formula = formulas(number)
    formula.evaluate(derived(number), Array.emptyDoubleArray, formula.parametersOf(quantity))

  /** Whether these are of this form, for so many vehicles. */
  def fits(quantities: Vector[Quantity], vehicles: Int): Boolean =
    vehicles == count && quantities.size == formulas.size &&
      formulas.indices.forall(number => formulas(number).fits(quantities(number)))

private[lanes] object QuantityLanes:
  private final val FirstParameter = 1 << 20
  private final val Stride         = 1 << 18

  private val known = CopyOnWriteArrayList[QuantityLanes]()

  /** How quantities of so many vehicles are computed by lanes, or why they are not. Compiled once for each form. */
  def of(quantities: Vector[Quantity], vehicles: Int): Either[Untraceable, QuantityLanes] =
    find(quantities, vehicles).map(Right(_)).getOrElse(known.synchronized:
      find(quantities, vehicles).map(Right(_)).getOrElse:
        val formulas = quantities.map(formulaOf(_, vehicles))
        formulas.collectFirst { case Left(refused) => refused } match
          case Some(refused) => Left(refused)
          case None          =>
            try
              val made = QuantityLanes(formulas.flatMap(_.toOption), vehicles)
              known.add(made): Unit
              Right(made)
            catch case refused: Untraceable => Left(refused))

  private def find(quantities: Vector[Quantity], vehicles: Int): Option[QuantityLanes] =
    var i = 0
    while i < known.size do
      if known.get(i).fits(quantities, vehicles) then return Some(known.get(i))
      i += 1
    None

  private def formulaOf(quantity: Quantity, vehicles: Int): Either[Untraceable, Formula] =
    // Who writes a quantity may call its argument as they like.
    val argument = quantity.getClass.getMethod("of", classOf[Positions]).getParameters.head.getName
    Formula.of(
      quantity,
      "of",
      Seq("northM", "eastM", "downM").map(field => s"$argument.$field" -> vehicles).toMap,
      Some(Seq(classOf[Positions]))
    )
