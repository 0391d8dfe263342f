package skein.simd

import java.util.concurrent.ConcurrentHashMap
import scala.collection.mutable
import skein.formula.{Node, Op, Trace}
import skein.simd.{LaneCompiler, LaneFunction}

/** A compiled function, and which inputs of the expressions it was compiled from are its inputs. Expressions
  * that are alike but for the numbers of their inputs share the code. Parameters are the same in all worlds.
  *
  * @param inputs numbers in the expressions, in the order of the function's inputs
  * @param nodes the expressions with the numbers of the function's inputs
  */
private[skein] final class BoundFunction private (
    val inputs: Array[Int],
    val nodes: Vector[Node],
    val function: LaneFunction
):
  /** The function's number of an input of the expressions. */
  def place(input: Int): Int = inputs.indexOf(input)

  /** How many there are. */
  def outputs: Int = nodes.size

private[skein] object BoundFunction:
  private type Key = (Vector[(Op, Vector[Int], Long)], Vector[Int], Vector[(Int, Int)])
  private val compiled = ConcurrentHashMap[Key, LaneFunction]()

  /** @param rowOf the rows of inputs that stand in one array, by their numbers in the expressions; of all of
    *   these, [[LaneCall.input]] takes the array and where its first row begins
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
      compiled.computeIfAbsent(key, _ => LaneCompiler.compile(inputs.size, own, places = places))
    BoundFunction(inputs.toArray, own, function)

  private def leafOf(node: Node): Long =
    if node.isConst then java.lang.Double.doubleToRawLongBits(node.value) else node.index.toLong

/** Calls a [[BoundFunction]] on arrays that are put in the places of its inputs and outputs. Mutable.
  *
  * @param parameters read at each call
  */
private[skein] final class LaneCall(bound: BoundFunction, parameters: Array[Float] = Array.emptyFloatArray):
  private val arrays   = Array.ofDim[Array[Float]](bound.inputs.length + bound.outputs)
  private val offsets  = Array.ofDim[Int](arrays.length)
  private val starts   = Array.ofDim[Int](arrays.length)
  private val strides  = Array.ofDim[Int](arrays.length)
  private val scratch  = Array.ofDim[Float](bound.function.scratch)
  private val function = bound.function
  private var worlds   = LaneFunction.COUNT

  /** From now on the first worlds alone count. */
  def use(worlds: Int): Unit = this.worlds = worlds

  /** Where an input's numbers begin, by the function's number of it. */
  def input(number: Int, array: Array[Float], offset: Int, stride: Int = 0): Unit =
    // Nearly always the same one: to store a reference costs the collector's bookkeeping.
    if arrays(number) ne array then arrays(number) = array
    offsets(number) = offset
    if stride != strides(number) || stride > 0 then
      starts(number) = offset
      strides(number) = stride

  /** The same of an input that the function need not have: its number is −1 then. */
  def inputIfAny(number: Int, array: Array[Float], offset: Int = 0, stride: Int = 0): Unit =
    if number >= 0 then input(number, array, offset, stride)

  def output(number: Int, array: Array[Float], offset: Int, stride: Int = 0): Unit =
    input(bound.inputs.length + number, array, offset, stride)

  def apply(): Unit = function.apply(arrays, offsets, parameters, scratch, worlds)

  /** What goes on goes back to where it was put. */
  def rewind(): Unit =
    var i = 0
    while i < offsets.length do
      if strides(i) > 0 then offsets(i) = starts(i)
      i += 1

  /** Afterwards everything begins its stride further on, or, at the end of an array, at its start. */
  def next(): Unit =
    apply()
    var i = 0
    while i < offsets.length do
      val on = offsets(i) + strides(i)
      offsets(i) = if strides(i) > 0 && on >= arrays(i).length then 0 else on
      i += 1
