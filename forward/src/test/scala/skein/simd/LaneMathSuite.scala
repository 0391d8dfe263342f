package skein.simd

class LaneMathSuite extends munit.FunSuite:
  private val count = 1 << 16

  private def largestError(of: Array[Float], exact: Int => Double): Double =
    (0 until count).map(i => math.abs(of(i) - exact(i))).max

  private def spread(from: Double, to: Double): Array[Float] =
    Array.tabulate(count)(i => (from + (to - from) * i / (count - 1)).toFloat)

  private def atan2(ys: Array[Float], xs: Array[Float]): Array[Float] =
    val out = Array.ofDim[Float](ys.length)
    LaneMath.atan2(ys, xs, out, ys.length)
    out

  for (limit, bound) <- Seq(math.Pi -> 1e-7, 8192.0 -> 3e-7) do
    test(s"sine and cosine err by less than $bound up to ±$limit"):
      val angles  = spread(-limit, limit)
      val sines   = Array.ofDim[Float](count)
      val cosines = Array.ofDim[Float](count)
      LaneMath.sinCos(angles, sines, cosines, count)
      val sinError = largestError(sines, i => math.sin(angles(i)))
      val cosError = largestError(cosines, i => math.cos(angles(i)))
      assert(sinError < bound, sinError)
      assert(cosError < bound, cosError)

  test("the angle of a point errs by less than 3e-7 in all directions and at all distances"):
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

  test("the exponential errs by less than 2e-7 of its value, and is exactly 1 at 0"):
    val xs  = spread(-20, 20)
    val out = xs.clone
    LaneMath.exp(out, 0, count)
    val error = (0 until count).map(i => math.abs(out(i) / math.exp(xs(i)) - 1)).max
    assert(error < 2e-7, error)
    val zeros = Array.ofDim[Float](LaneMath.LANES)
    LaneMath.exp(zeros, 0, zeros.length)
    assertEquals(zeros.toSeq, Seq.fill(zeros.length)(1f))
