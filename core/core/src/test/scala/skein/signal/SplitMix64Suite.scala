package skein.signal

class SplitMix64Suite extends munit.FunSuite:

  test("the sequence of seed 1234567 is the published one"):
    val random = SplitMix64(1234567L)
    val first  = List.fill(5)(java.lang.Long.toUnsignedString(random.nextLong()))
    assertEquals(
      first,
      List(
        "6457827717110365317",
        "3203168211198807973",
        "9817491932198370423",
        "4593380528125082431",
        "16408922859458223821"
      )
    )

  test("doubles stay in [0, 1) and fill it evenly"):
    val random = SplitMix64(7)
    val counts = new Array[Int](10)
    for _ <- 1 to 100_000 do
      val u = random.nextDouble()
      assert(u >= 0 && u < 1)
      counts((u * 10).toInt) += 1
    counts.foreach(count => assert(math.abs(count - 10_000) < 400, counts.toList))

  test("integers are below their bound and equally frequent"):
    val random = SplitMix64(8)
    val counts = new Array[Int](7)
    for _ <- 1 to 70_000 do counts(random.nextInt(7)) += 1
    counts.foreach(count => assert(math.abs(count - 10_000) < 400, counts.toList))

  test("sequences of one seed differ from each other and from those of the next seed"):
    val seeds = for seed <- 0 until 50; index <- 0 until 50 yield SplitMix64.seedOf(seed, index)
    assertEquals(seeds.distinct.size, seeds.size)

  test("exponential numbers have the given mean"):
    val random = SplitMix64(11)
    val mean   = Iterator.fill(100_000)(random.nextExponential(40)).sum / 100_000
    assertEqualsDouble(mean, 40, 0.5)
