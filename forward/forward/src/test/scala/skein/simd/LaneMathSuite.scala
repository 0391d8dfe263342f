package skein.simd

import skein.formula.{Node, Op, Trace}

class LaneMathSuite extends munit.FunSuite:
  private val count = 1 << 16

  private def largestError(of: Array[Float], exact: Int => Double): Double =
    (0 until count).map(i => math.abs(of(i) - exact(i))).max

  private def spread(from: Double, to: Double): Array[Float] =
    Array.tabulate(count)(i => (from + (to - from) * i / (count - 1)).toFloat)

  private def compiled(op: Op, xs: Array[Float]): Array[Float] = compiled(_.unary(op, _), xs)

  private def atan2(ys: Array[Float], xs: Array[Float]): Array[Float] =
    compiled((trace, y) => trace.binary(Op.Atan2, y, trace.input(1)), ys, xs)

  private def compiled(of: (Trace, Node) => Node, inputs: Array[Float]*): Array[Float] =
    val trace    = Trace()
    val function = LaneCompiler.compile(inputs.size, Vector(of(trace, trace.input(0))))
    val into     = Array.ofDim[Float](inputs.head.length)
    val scratch  = Array.ofDim[Float](function.scratch)
    for at <- into.indices by LaneFunction.COUNT do
      val worlds = LaneFunction.COUNT.min(into.length - at)
      val arrays = (inputs :+ into).toArray
      function.apply(arrays, arrays.map(_ => at), Array.emptyFloatArray, scratch, worlds)
    into

  for
    (op, exact, limit, bound) <- Seq[(Op, Double => Double, Double, Double)](
      (Op.Sin, math.sin, math.Pi, 1e-7),
      (Op.Cos, math.cos, math.Pi, 1e-7),
      (Op.Sin, math.sin, 8192, 3e-7),
      (Op.Cos, math.cos, 8192, 3e-7),
      (Op.Atan, math.atan, 20, 3e-7),
      (Op.Asin, math.asin, 1, 6e-7),
      (Op.Acos, math.acos, 1, 6e-7),
      (Op.Tanh, math.tanh, 12, 1e-6)
    )
  do
    test(s"compiled $op has an error below $bound up to ±$limit"):
      val xs    = spread(-limit, limit)
      val error = largestError(compiled(op, xs), i => exact(xs(i)))
      assert(error < bound, error)

  test("a condition is compiled once, however many others contain it, and may be used in several passes"):
    val trace         = Trace()
    def input(i: Int) = trace.input(i)
    var inside        = trace.lt(input(0), trace.const(0))
    def on(i: Int)    = trace.lt(input(0), trace.const(i))
    for i <- 1 to 40 do
      inside = trace.or(trace.and(inside, on(2 * i)), trace.and(trace.not(inside), on(2 * i + 1)))
    // Longer than a pass: the condition is needed again behind it.
    var sum = trace.where(inside, input(0), input(1))
    for i <- 1 to 60 do sum = trace.unary(Op.Sqrt, trace.add(trace.unary(Op.Abs, sum), trace.const(i)))
    val chosen   = trace.where(inside, sum, trace.neg(sum))
    val function = LaneCompiler.compile(2, Vector(chosen))
    val into     = Array.ofDim[Float](LaneFunction.COUNT)
    val xs       = Array.tabulate(LaneFunction.COUNT)(i => i - 20.5f)
    function.apply(
      Array(xs, xs, into),
      Array(0, 0, 0),
      Array.emptyFloatArray,
      Array.ofDim[Float](function.scratch)
    )
    for (x, i) <- xs.zipWithIndex do
      var holds = x < 0
      for k <- 1 to 40 do holds = if holds then x < 2 * k else x < 2 * k + 1
      assertEquals(into(i) > 0, holds, s"$x")

  test("the compiled exponential has a relative error below 2.5e-7"):
    val xs    = spread(-20, 20)
    val out   = compiled(Op.Exp, xs)
    val error = (0 until count).map(i => math.abs(out(i) / math.exp(xs(i)) - 1)).max
    assert(error < 2.5e-7, error)

  test("overflow and NaN agree with doubles"):
    val lanes                  = LaneFunction.COUNT
    def one(op: Op, x: Double) = compiled(op, Array.fill(lanes)(x.toFloat)).head
    def two(op: Op, x: Double, y: Double) =
      // Quotients, which may be NaN.
      val of = (trace: Trace, x: Node) =>
        trace.binary(op, trace.div(x, trace.input(1)), trace.div(trace.input(2), trace.input(1)))
      compiled(of, Array.fill(lanes)(x.toFloat), Array.fill(lanes)(1f), Array.fill(lanes)(y.toFloat)).head
    assertEquals((one(Op.Exp, 89), one(Op.Exp, -100)), (Float.PositiveInfinity, 0f))
    for op <- Seq(Op.Exp, Op.Asin, Op.Acos, Op.Tanh) do assert(one(op, Double.NaN).isNaN, op)
    for x <- Seq(1.5, -1.5, 20, -20); op <- Seq(Op.Asin, Op.Acos) do assert(one(op, x).isNaN, s"$op($x)")
    assertEquals(one(Op.Acos, 1.0000005), 0f)
    for op <- Seq(Op.Min, Op.Max); (x, y) <- Seq((Double.NaN, 1.0), (1.0, Double.NaN)) do
      assert(two(op, x, y).isNaN, s"$op($x, $y)")
    assertEquals((two(Op.Min, 2, 1), two(Op.Max, 2, 1)), (1f, 2f))

  test("the angle of a point has an error below 3e-7 in all directions and at all distances"):
    val angles = spread(-math.Pi, math.Pi)
    for distance <- Seq(1e-3, 1.0, 1e5) do
      val ys    = angles.map(a => (distance * math.sin(a)).toFloat)
      val xs    = angles.map(a => (distance * math.cos(a)).toFloat)
      val error = largestError(atan2(ys, xs), i => math.atan2(ys(i), xs(i)))
      assert(error < 3e-7, error)

  test("the angle is exact on the axes and 0 at the origin"):
    def one(y: Float, x: Float) = atan2(Array.fill(LaneMath.LANES)(y), Array.fill(LaneMath.LANES)(x)).head
    assertEquals(one(0, 0), 0f)
    assertEquals(one(0, 2), 0f)
    assertEquals(one(3, 0), math.Pi.toFloat / 2)
    assertEquals(one(-3, 0), -math.Pi.toFloat / 2)
    assertEquals(one(0, -2), math.Pi.toFloat)
