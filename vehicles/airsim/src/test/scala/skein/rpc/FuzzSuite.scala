package skein.rpc

/** A short version of [[Fuzz]], without sockets. */
class FuzzSuite extends munit.FunSuite:

  test("of 20,000 mutated sequences, the codec reads what the oracle reads, and refuses the rest"):
    val figures = CodecFuzz.run(20_000, seed = 1)
    assert(
      figures.values > 5_000 && figures.cut > 1_000 && figures.refused > 1_000 && figures.whole > 1_000,
      s"$figures"
    )
