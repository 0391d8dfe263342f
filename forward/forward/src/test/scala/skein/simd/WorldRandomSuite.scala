package skein.simd

class WorldRandomSuite extends munit.FunSuite:

  test("vectors and scalars give equal bits"):
    val keys = Array.tabulate(256)(WorldRandom.key(1, 2, _))
    val bits = Array.ofDim[Int](256)
    for place <- Seq(0, 1, 17, 9599) do
      LaneRandom.bits(keys, place, bits, 256)
      for i <- keys.indices do assertEquals(bits(i), WorldRandom.bits(keys(i), place))

  test("a world's sequence fills 64 bins evenly"):
    val draws  = 64 * 1000
    val counts = Array.ofDim[Int](64)
    val key    = WorldRandom.key(42, 7, 3)
    for place <- 0 until draws do counts(WorldRandom.bits(key, place) >>> 26) += 1
    val chiSquare = counts.map(n => (n - 1000.0) * (n - 1000.0) / 1000).sum
    assert(chiSquare > 30 && chiSquare < 110, chiSquare) // 63 degrees of freedom: 0.1 % on either side

  test("neighbouring episodes and indices are uncorrelated"):
    val n                                         = 20000
    def uniform(key: Int, place: Int)             = (WorldRandom.bits(key, place) >>> 8) / 16777216.0 - 0.5
    def correlation(pairs: Seq[(Double, Double)]) = 12 * pairs.map(_ * _).sum / n
    val episodes                                  =
      (0 until n).map(i => (uniform(WorldRandom.key(1, 0, i), 5), uniform(WorldRandom.key(1, 0, i + 1), 5)))
    val places = (0 until n).map(i => (uniform(99, i), uniform(99, i + 1)))
    assert(correlation(episodes).abs < 0.03, correlation(episodes))
    assert(correlation(places).abs < 0.03, correlation(places))
