package skein.lanes

import skein.formula.{Angles, Formula, Node, Trace}

/** A method of one object, compiled with the object's own numbers, the same in all worlds.
  *
  * @param extra
  *   inputs behind the method's own
  * @param changed
  *   what is computed in the place of the method's outputs
  */
private[lanes] final class FixedFormula(
    formula: Formula,
    of: AnyRef,
    extra: Int = 0,
    changed: (Trace, Vector[Node]) => Vector[Node] = (_, outputs) => outputs
):
  import FixedFormula.First
  private val inputs = formula.inputs.size + extra

  /** What is computed of the inputs and of the object's own numbers; and these. */
  val (bound, numbers) =
    val trace  = Trace()
    val angles =
      Angles(formula.trace, trace, trace.input, _ => None, number => trace.input(First + number))
    val outputs = changed(trace, formula.outputs.map((_, node) => angles.convert(node)))
    val values  = formula.evaluate(angles.derived, Array.emptyDoubleArray, formula.parametersOf(of))
    (BoundFunction.of(outputs), values)

  /** The inputs of [[bound]] for those of the method. */
  def inputsOf(own: Array[Double]): Array[Double] =
    bound.inputs.map(input => if input < First then own(input) else numbers(input - First))

  def call: FixedFormula.Call = FixedFormula.Call(bound, numbers, inputs)

private[lanes] object FixedFormula:
  /** The first of the inputs that are the object's numbers. */
  private val First = 1 << 20

  /** Mutable. */
  final class Call(bound: BoundFunction, numbers: Array[Double], inputs: Int):
    private val call   = LaneCall(bound)
    private val places = Array.fill(inputs)(-1)
    for (input, place) <- bound.inputs.zipWithIndex do
      if input < First then places(input) = place
      else call.input(place, Array.fill(TimetableVehicles.WORLDS)(numbers(input - First).toFloat), 0)

    /** From where in an array on an input's numbers stand, one of each world. */
    def input(number: Int, array: Array[Float], from: Int): Unit =
      if places(number) >= 0 then call.input(places(number), array, from)

    /** So many inputs, one after the other, from one on. */
    def inputs(first: Int, count: Int, array: Array[Float], from: Int): Unit =
      var i = 0
      while i < count do
        input(first + i, array, from + i * TimetableVehicles.WORLDS)
        i += 1

    def output(number: Int, array: Array[Float], from: Int): Unit = call.output(number, array, from)

    /** So many outputs, one after the other, from the first on. */
    def outputs(count: Int, array: Array[Float], from: Int): Unit =
      for i <- 0 until count do output(i, array, from + i * TimetableVehicles.WORLDS)

    def apply(): Unit = call()
