package skein.simd

import java.util.concurrent.ConcurrentHashMap
import skein.formula.{Angles, Evaluation, Formula, Fused, Trace, Untraceable}
import skein.simd.LaneFunction

/** A method of one object, compiled with the object's own numbers, the same in all worlds.
  *
  * @param alike so many of the method's last inputs are the same in all worlds too
  * @param bound what is computed of the inputs and of [[parameters]]
  * @param evaluation how the object's own numbers make those
  */
private[skein] final class FixedFormula private (
    formula: Formula,
    of: AnyRef,
    val alike: Int,
    private[skein] val bound: BoundFunction,
    evaluation: Evaluation
):
  private val own = formula.inputs.size - alike

  /** The names of the method's inputs. */
  def inputs: Vector[String] = formula.inputs

  /** Whether another object's method is this formula, with numbers of its own. */
  def fits(other: AnyRef): Boolean = formula.fits(other)

  /** That of another object that [[fits]]. */
  def of(other: AnyRef): FixedFormula =
    if other eq of then this else new FixedFormula(formula, other, alike, bound, evaluation)

  /** Behind the inputs that are alike: what an object that [[fits]] is computed with. */
  private[skein] def parametersOf(other: AnyRef): Array[Double] =
    Array.ofDim[Double](alike) ++ evaluation(Array.emptyDoubleArray, formula.parametersOf(other))

  private[skein] val parameters: Array[Double] = parametersOf(of)

  /** The inputs of [[bound]] for those of the method. */
  private[skein] def inputsOf(own: Array[Double]): Array[Double] = bound.inputs.map(own(_))

  /** For the object that it was compiled for. */
  def call: FixedFormula.Call = call(of)

  /** For another that [[fits]]. */
  def call(other: AnyRef): FixedFormula.Call =
    FixedFormula.Call(this, parametersOf(other).map(_.toFloat), own)

private[skein] object FixedFormula:
  private val known = ConcurrentHashMap[(Class[?], String, Int), Forms[AnyRef, FixedFormula]]()

  /** @param rows so many of the first inputs stand in one array, row by row, and all outputs in another
    */
  def apply(
      formula: Formula,
      of: AnyRef,
      alike: Int = 0,
      rows: Int = 0
  ): FixedFormula =
    val own    = formula.inputs.size - alike
    val trace  = Trace()
    val angles = Angles(
      formula.trace,
      trace,
      input => if input < own then trace.input(input) else trace.param(input - own),
      _ => None,
      number => trace.param(alike + number)
    )
    val fused = Fused(formula.trace, formula.outputs.map(_._2)).nodes
    val bound =
      BoundFunction.of(fused.map(angles.convert), { case input if input < rows => input }, areRows = rows > 0)
    new FixedFormula(formula, of, alike, bound, Evaluation(angles.derived))

  /** An object's method, which is compiled once for all objects of a form.
    *
    * @param alike so many of the method's last inputs are the same in all worlds
    */
  def of(target: AnyRef, method: String, alike: Int): Either[Untraceable, FixedFormula] =
    known
      .computeIfAbsent(
        (target.getClass, method, alike),
        _ =>
          Forms[AnyRef, FixedFormula](_.fits(_)): one =>
            Formula.of(one, method).map(FixedFormula(_, one, alike))
      )(target)
      .map(_.of(target))

  /** Mutable. */
  final class Call(formula: FixedFormula, parameters: Array[Float], own: Int):
    private val call   = LaneCall(formula.bound, parameters)
    private val places = Array.fill(own)(-1)
    for (input, place) <- formula.bound.inputs.zipWithIndex do places(input) = place

    /** From now on for another object, which [[FixedFormula.fits]]. */
    def take(of: AnyRef): Unit =
      val numbers = formula.parametersOf(of)
      for i <- formula.alike until numbers.length do parameters(i) = numbers(i).toFloat

    /** An input that is the same in all worlds. */
    def everywhere(number: Int, value: Float): Unit = parameters(number - own) = value

    /** From where in an array on an input's numbers stand, one of each world. */
    def input(number: Int, array: Array[Float], from: Int): Unit =
      if places(number) >= 0 then call.input(places(number), array, from)

    /** So many inputs, one after the other, from one on. */
    def inputs(first: Int, count: Int, array: Array[Float], from: Int): Unit =
      var i = 0
      while i < count do
        input(first + i, array, from + i * LaneFunction.COUNT)
        i += 1

    def output(number: Int, array: Array[Float], from: Int): Unit = call.output(number, array, from)

    /** An input of which each [[next]] call takes the next row, and after the last the first.
      *
      * @param apart so many numbers
      */
    def rows(number: Int, array: Array[Float], from: Int, apart: Int): Unit =
      if places(number) >= 0 then call.input(places(number), array, from, apart)

    def outputRows(number: Int, array: Array[Float], from: Int, apart: Int): Unit =
      call.output(number, array, from, apart)

    /** So many outputs, one after the other, from the first on. */
    def outputs(count: Int, array: Array[Float], from: Int): Unit =
      var i = 0
      while i < count do
        output(i, array, from + i * LaneFunction.COUNT)
        i += 1

    /** From now on the first worlds alone count. */
    def use(worlds: Int): Unit = call.use(worlds)

    def apply(): Unit = call()

    /** Afterwards rows are the next ones. */
    def next(): Unit = call.next()

    /** Goes back to the first rows. */
    def rewind(): Unit = call.rewind()
