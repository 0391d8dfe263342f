package skein.rpc

/** A short version of [[Fuzz]], without sockets. */
class FuzzSuite extends munit.FunSuite:

  test("the codec reads 20,000 mutated sequences as the oracle does, and refuses the rest"):
    val figures = CodecFuzz.run(20_000, seed = 1)
    assert(
      figures.values > 5_000 && figures.cut > 1_000 && figures.refused > 1_000 && figures.whole > 1_000,
      s"$figures"
    )
