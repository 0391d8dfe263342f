package skein.simd

import scala.collection.mutable
import skein.formula.{Node, Op, Trace}
import skein.simd.{LaneCompiler, LaneFunction}
import skein.units.eachBelow

/** A compiled function and the mapping of its inputs to the expressions' inputs. Expressions that are equal
  * except for the indices of their inputs share the code. Parameters are equal in all worlds.
  *
  * @param inputs the index in the expressions of each input of the function
  * @param nodes the expressions, with their inputs renumbered as in the function
  */
private[skein] final class BoundFunction private (
    val inputs: Array[Int],
    val nodes: Vector[Node],
    val function: LaneFunction
):
  /** The function's index of an expression's input; −1 if the input is unused. */
  def place(input: Int): Int = inputs.indexOf(input)

  def outputs: Int = nodes.size

private[skein] object BoundFunction:
  private type Key = (Vector[(Op, Vector[Int], Long)], Vector[Int], Vector[(Int, Int)])
  private val compiled = Recent[Key, LaneFunction](most = 1024)

  /** Compiles expressions; equal ones only once.
    *
    * @param rowOf row of each input, by its index in the expressions, for inputs that share an array.
    *   [[LaneCall.input]] of the first of them takes the array and the offset of its row 0
    * @param areRows whether the outputs are the rows of one array
    */
  def of(
      outputs: Vector[Node],
      rowOf: PartialFunction[Int, Int] = PartialFunction.empty,
      areRows: Boolean = false
  ): BoundFunction =
    val trace  = Trace()
    val number = mutable.LinkedHashMap.empty[Int, Int]
    val own    = Trace.replaced(outputs, trace): node =>
      Option.when(node.op == Op.Input)(trace.input(number.getOrElseUpdate(node.index, number.size)))
    val inputs = number.keys.toVector
    val shared = inputs.indexWhere(rowOf.isDefinedAt)
    val places = inputs.indices.toVector.map(i => rowOf.lift(inputs(i)).fold((i, 0))((shared, _))) ++
      own.indices.map(i => if areRows then (inputs.size, i) else (inputs.size + i, 0))
    val needed   = Trace.needed(own)
    val key: Key = (needed.map(node => (node.op, node.args.map(_.id), leafOf(node))), own.map(_.id), places)
    val function =
      compiled.getOrMake(key)(LaneCompiler.compile(inputs.size, own, places = places))
    BoundFunction(inputs.toArray, own, function)

  private def leafOf(node: Node): Long =
    if node.isConst then java.lang.Double.doubleToRawLongBits(node.value) else node.index.toLong

/** Calls a [[BoundFunction]] with arrays for its inputs and outputs. Mutable.
  *
  * @param parameters the array of parameters, read at each call
  */
private[skein] final class LaneCall(bound: BoundFunction, parameters: Array[Float] = Array.emptyFloatArray):
  private val arrays   = Array.ofDim[Array[Float]](bound.inputs.length + bound.outputs)
  private val offsets  = Array.ofDim[Int](arrays.length)
  private val starts   = Array.ofDim[Int](arrays.length)
  private val strides  = Array.ofDim[Int](arrays.length)
  private val scratch  = Array.ofDim[Float](bound.function.scratch)
  private val function = bound.function
  private var worlds   = LaneFunction.COUNT

  /** Limits evaluation to the first worlds, until the next call. */
  def use(worlds: Int): Unit = this.worlds = worlds

  /** Sets the array of an input, by the function's index, with the offset for this call and the distance by
    * which [[next]] advances it.
    */
  def input(number: Int, array: Array[Float], offset: Int, stride: Int = 0): Unit =
    // Nearly always the array is unchanged, and storing a reference costs the garbage collector's
    // bookkeeping.
    if arrays(number) ne array then arrays(number) = array
    offsets(number) = offset
    if stride != strides(number) || stride > 0 then
      starts(number) = offset
      strides(number) = stride

  /** Sets the array of an input unless its index is −1, which means that the function does not use it. */
  def inputIfAny(number: Int, array: Array[Float], offset: Int = 0, stride: Int = 0): Unit =
    if number >= 0 then input(number, array, offset, stride)

  def output(number: Int, array: Array[Float], offset: Int, stride: Int = 0): Unit =
    input(bound.inputs.length + number, array, offset, stride)

  def apply(): Unit = function.apply(arrays, offsets, parameters, scratch, worlds)

  /** Rewinds strided arguments to their first offsets. */
  def rewind(): Unit =
    eachBelow(offsets.length): i =>
      if strides(i) > 0 then offsets(i) = starts(i)

  /** Evaluates the function, and then advances every argument by its stride. A strided argument that passes
    * the end of its array returns to offset 0.
    */
  def next(): Unit =
    apply()
    eachBelow(offsets.length): i =>
      val on = offsets(i) + strides(i)
      offsets(i) = if strides(i) > 0 && on >= arrays(i).length then 0 else on
