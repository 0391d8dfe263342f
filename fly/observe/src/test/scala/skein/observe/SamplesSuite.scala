package skein.observe

class SamplesSuite extends munit.FunSuite:
  test("samples may be added after a distribution was taken"):
    val samples = Samples()
    for number <- 1 to 300 do
      samples.add(number)
      val so = samples.distribution.get
      assertEquals((so.count, so.least, so.most), (number, 1.0, number.toDouble))

  test("beyond a million samples the mean is still updated, and the distribution keeps the first ones"):
    val samples = Samples()
    for number <- 1 to 1_000_100 do samples.add(number % 2)
    assertEquals((samples.added, samples.distribution.map(_.count)), (1_000_100L, Some(1_000_000)))
    assertEquals(samples.mean, Some(0.5))
