package skein.measure

class DistributionSuite extends munit.FunSuite:

  test("the quantiles of the numbers from 0 to 1000 are those numbers"):
    val numbers = Distribution.of((0 to 1000).reverse.map(_.toDouble)).get
    assertEquals((numbers.least, numbers.most, numbers.count), (0.0, 1000.0, 1001))
    assertEqualsDouble(numbers.median, 500, 1e-9)
    assertEqualsDouble(numbers.p99, 990, 1e-9)
    assertEqualsDouble(numbers.quantile(0.3), 300, 1e-9)
    assertEqualsDouble(numbers.mean, 500, 1e-9)

  test("each quantile of a single sample is that sample; without samples there is no distribution"):
    val one = Distribution.of(Seq(7.0)).get
    assertEquals((one.least, one.median, one.p99, one.most, one.sd), (7.0, 7.0, 7.0, 7.0, 0.0))
    assertEquals(Distribution.of(Seq.empty), None)
