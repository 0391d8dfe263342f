package skein.simd

import java.util.concurrent.ConcurrentHashMap
import skein.formula.{Angles, Evaluation, Formula, Fused, Trace, Untraceable}
import skein.simd.LaneFunction
import skein.units.eachBelow

/** A compiled method of one object. The object's own fields are parameters, which are equal in all worlds.
  *
  * @param alike number of the method's last inputs that are also equal in all worlds
  * @param bound computes the result from the inputs and [[parameters]]
  * @param evaluation computes the parameters from the object's own fields
  */
private[skein] final class FixedFormula private (
    formula: Formula,
    of: AnyRef,
    val alike: Int,
    private[skein] val bound: BoundFunction,
    evaluation: Evaluation
):
  private val own = formula.inputs.size - alike

  def inputs: Vector[String] = formula.inputs

  /** Whether another object's method differs from this formula only in the values of its fields. */
  def fits(other: AnyRef): Boolean = formula.fits(other)

  def of(other: AnyRef): FixedFormula =
    if other eq of then this else new FixedFormula(formula, other, alike, bound, evaluation)

  /** The parameters for an object that [[fits]]: room for the inputs that are equal in all worlds, then its
    * own.
    */
  private[skein] def parametersOf(other: AnyRef): Array[Double] =
    Array.ofDim[Double](alike) ++ evaluation(Array.emptyDoubleArray, formula.parametersOf(other))

  private[skein] val parameters: Array[Double] = parametersOf(of)

  def call: FixedFormula.Call = call(of)

  def call(other: AnyRef): FixedFormula.Call =
    FixedFormula.Call(this, parametersOf(other).map(_.toFloat), own)

private[skein] object FixedFormula:
  private val known = ConcurrentHashMap[(Class[?], String, Int), Forms[AnyRef, FixedFormula]]()

  /** Compiles a formula.
    *
    * @param rows number of the first inputs that are rows of one array; if above 0, all outputs are rows of
    *   another
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

  /** Compiles an object's method, once for all objects of a form. Left says why SIMD does not support it.
    *
    * @param alike number of the method's last inputs that are equal in all worlds
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

  final class Call(formula: FixedFormula, parameters: Array[Float], own: Int):
    private val call   = LaneCall(formula.bound, parameters)
    private val places = Array.fill(own)(-1)
    for (input, place) <- formula.bound.inputs.zipWithIndex do places(input) = place

    /** Replaces the object by another object, which must fit (see [[FixedFormula.fits]]). */
    def take(of: AnyRef): Unit =
      val numbers = formula.parametersOf(of)
      for i <- formula.alike until numbers.length do parameters(i) = numbers(i).toFloat

    /** Sets an input that is equal in all worlds. */
    def everywhere(number: Int, value: Float): Unit = parameters(number - own) = value

    /** Sets the array and offset of an input that has one value per world. */
    def input(number: Int, array: Array[Float], from: Int): Unit =
      if places(number) >= 0 then call.input(places(number), array, from)

    /** Binds `count` consecutive inputs from `first` to `array`. */
    def inputs(first: Int, count: Int, array: Array[Float], from: Int): Unit =
      eachBelow(count): i =>
        input(first + i, array, from + i * LaneFunction.COUNT)

    def output(number: Int, array: Array[Float], from: Int): Unit = call.output(number, array, from)

    /** Binds an input that advances by a row at each [[next]] call, and returns to the first row after the
      * last.
      *
      * @param apart distance between the rows
      */
    def rows(number: Int, array: Array[Float], from: Int, apart: Int): Unit =
      if places(number) >= 0 then call.input(places(number), array, from, apart)

    def outputRows(number: Int, array: Array[Float], from: Int, apart: Int): Unit =
      call.output(number, array, from, apart)

    /** Binds the first `count` outputs consecutively to `array`. */
    def outputs(count: Int, array: Array[Float], from: Int): Unit =
      eachBelow(count): i =>
        output(i, array, from + i * LaneFunction.COUNT)

    /** Limits evaluation to the first worlds, until the next call. */
    def use(worlds: Int): Unit = call.use(worlds)

    def apply(): Unit = call()

    def next(): Unit = call.next()

    def rewind(): Unit = call.rewind()
