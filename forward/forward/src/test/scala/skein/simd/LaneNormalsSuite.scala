package skein.simd

import skein.signal.{NormalQuantile, SplitMix64}

class LaneNormalsSuite extends munit.FunSuite:
  test("normal deviates equal those of the scalar functions, to the bit"):
    val count  = 1 << 16
    val random = SplitMix64(7)
    val bits   = Array.tabulate(count): at =>
      if at < 2 then -at.toLong else if at < 16 then 1L << 4 * at - 1 else random.nextLong()
    val normal = Array.ofDim[Double](count)
    LaneNormals.of(bits, 0, count, normal)
    for at <- bits.indices do
      assertEquals(
        normal(at),
        NormalQuantile(((bits(at) >>> 11) * math.pow(2, -53)).max(1e-12)),
        s"${bits(at)}"
      )

  test("mixed numbers are those of the scalar generator"):
    assertEquals(SplitMix64.mix(5 + SplitMix64.Gamma), SplitMix64(5).nextLong())
