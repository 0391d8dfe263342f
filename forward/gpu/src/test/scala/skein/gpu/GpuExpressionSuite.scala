package skein.gpu

import skein.formula.{Node, Op, Trace}
import skein.signal.SplitMix64
import skein.simd.{LaneCompiler, LaneFunction}

/** Compares every operation of formulas on a GPU with SIMD, bit by bit, for ordinary and for extreme numbers.
  */
class GpuExpressionSuite extends munit.FunSuite, TestGpus:
  private val count  = LaneFunction.COUNT
  private val trace  = Trace()
  private val (a, b) = (trace.input(0), trace.input(1))

  private val unary = Seq(
    Op.Neg,
    Op.Abs,
    Op.Sqrt,
    Op.Sin,
    Op.Cos,
    Op.Asin,
    Op.Acos,
    Op.Atan,
    Op.Exp,
    Op.Tanh,
    Op.Floor,
    Op.Ceil,
    Op.Rint,
    Op.Signum
  )

  private val binary = Seq(Op.Add, Op.Sub, Op.Mul, Op.Div, Op.Min, Op.Max, Op.Atan2, Op.Hypot, Op.Remainder)

  private def holds(condition: Node) = trace.where(condition, a, b)

  private val expressions: Vector[(String, Node)] =
    unary.map(op => op.toString -> trace.unary(op, a)).toVector ++
      binary.map(op => op.toString -> trace.binary(op, a, b)) ++
      Vector(
        "wrapped"      -> trace.binary(Op.Remainder, a, trace.const(2 * math.Pi)),
        "fused"        -> trace.add(trace.mul(a, b), a),
        "less"         -> holds(trace.lt(a, b)),
        "at most"      -> holds(trace.le(a, b)),
        "equal"        -> holds(trace.equal(a, b)),
        "not, and, or" -> holds(trace.or(
          trace.and(trace.lt(a, b), trace.lt(trace.const(0), b)),
          trace.not(trace.le(a, trace.const(1)))
        ))
      )

  private val edges = Array(
    0f,
    -0f,
    1f,
    -1f,
    Float.NaN,
    Float.PositiveInfinity,
    Float.NegativeInfinity,
    Float.MinPositiveValue,
    -1e-40f,
    Float.MaxValue,
    math.Pi.toFloat,
    88.5f,
    -90f,
    0.5f,
    1e8f,
    12582912f
  )

  private def inputs(seed: Long): Array[Array[Float]] =
    val random = SplitMix64(seed)
    Array.tabulate(2, count): (which, i) =>
      if i < edges.length * 4 then
        edges(if which == 0 then i % edges.length else (i * 7 + i / edges.length) % edges.length)
      else ((random.nextDouble() - 0.5) * math.pow(10, random.nextDouble() * 6 - 3)).toFloat

  private def bySimd(node: Node, of: Array[Array[Float]]): Array[Float] =
    val function = LaneCompiler.compile(2, Vector(node))
    val out      = Array.ofDim[Float](count)
    function.apply(
      Array(of(0), of(1), out),
      Array.ofDim[Int](3),
      Array.emptyFloatArray,
      Array.ofDim[Float](function.scratch)
    )
    out

  private def onGpu(gpu: Gpu, node: Node, of: Array[Array[Float]]): Array[Float] =
    val code             = Ptx("single", Seq("first", "second", "into").map(_ -> Ptx.Kind.Address))
    val thread           = code.thread()
    def at(name: String) = code.address(code.argument(name), thread)
    val read             = Vector(at("first"), at("second"))
    val told             =
      PtxExpressions.write(code, Vector(node))(input => code.load(read(input)), _ => fail("no parameters"))
    code.store(told(0), at("into"))
    code("ret")
    val buffers = of.toVector.map(gpu.buffer(_)) :+ gpu.buffer(count.toLong)
    try
      gpu.kernel(code.module, "single")(1, count, buffers*)
      buffers.last.floats()
    finally buffers.foreach(_.close())

  for (name, gpu) <- gpus; (expression, node) <- expressions do
    test(s"$name: $expression"):
      val seed          = 7L
      val of            = inputs(seed)
      val (simd, there) = (bySimd(node, of), onGpu(gpu(), node, of))
      for i <- 0 until count if !(simd(i).isNaN && there(i).isNaN) do
        assertEquals(
          java.lang.Float.floatToRawIntBits(there(i)),
          java.lang.Float.floatToRawIntBits(simd(i)),
          s"of ${of(0)(i)} and ${of(1)(i)}, seed $seed: ${there(i)} and ${simd(i)}"
        )
