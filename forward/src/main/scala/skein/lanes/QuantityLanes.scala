package skein.lanes

import skein.formula.{Angles, Formula, Node, Trace, Untraceable}
import skein.scenario.{Positions, Quantity}
import skein.units.Expect

/** How quantities are computed in many worlds at once, compiled from their methods [[Quantity.of]]: several
  * of one view, together. Quantities of one form differ in numbers alone.
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

  private val known =
    Forms[(Vector[Quantity], Int), QuantityLanes]((form, of) => form.fits(of._1, of._2)):
      (quantities, vehicles) =>
        Expect.each(quantities)(formulaOf(_, vehicles)).map(QuantityLanes(_, vehicles))

  /** How quantities of so many vehicles are computed by lanes, or why they are not. Compiled once for each
    * form.
    */
  def of(quantities: Vector[Quantity], vehicles: Int): Either[Untraceable, QuantityLanes] =
    known((quantities, vehicles))

  private def formulaOf(quantity: Quantity, vehicles: Int): Either[Untraceable, Formula] =
    // Who writes a quantity may call its argument as they like.
    val argument = quantity.getClass.getMethod("of", classOf[Positions]).getParameters.head.getName
    Formula.of(
      quantity,
      "of",
      Seq("northM", "eastM", "downM").map(field => s"$argument.$field" -> vehicles).toMap,
      Some(Seq(classOf[Positions]))
    )
