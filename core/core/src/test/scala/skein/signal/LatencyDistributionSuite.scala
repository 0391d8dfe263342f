package skein.signal

import skein.units.*

class LatencyDistributionSuite extends munit.FunSuite:
  import LatencyDistribution.*

  private def sampled(distribution: LatencyDistribution): Vector[Double] =
    val random = SplitMix64(1)
    Vector.fill(200_000)(distribution.quantile(random.nextDouble()).toMillis)

  private def meanAndSd(values: Vector[Double]): (Double, Double) =
    val mean = values.sum / values.size
    (mean, math.sqrt(values.map(v => (v - mean) * (v - mean)).sum / values.size))

  for (name, distribution, mean, sd) <- List(("direct", Direct, 36.8, 10.7), ("vpn", Vpn, 102.8, 25.6)) do
    test(s"samples of $name have the published mean and standard deviation within 1 ms"):
      val (sampledMean, sampledSd) = meanAndSd(sampled(distribution))
      assertEqualsDouble(sampledMean, mean, 1)
      assertEqualsDouble(sampledSd, sd, 1)
      assertEqualsDouble(distribution.mean.toMillis, sampledMean, 0.3)

  test("a published quantile is returned unchanged"):
    assertEquals(Direct.quantile(0), Span.ofMillis(17.8))
    assertEquals(Direct.quantile(0.5), Span.ofMillis(35.9))
    assertEquals(Vpn.quantile(0.99), Span.ofMillis(165.5))
    assertEquals(Vpn.quantile(1), Span.ofMillis(207.4))

  test("quantiles between published ones are interpolated linearly"):
    assertEquals(Direct.quantile(0.55), Span.ofMillis((35.9 + 40.1) / 2))

  test("the log-normal quantiles equal tabulated values"):
    val distribution = LogNormal(Span.ofMillis(36), 0.3)
    def z(p: Double) = math.log(distribution.quantile(p).toMillis / 36) / 0.3
    assertEqualsDouble(z(0.5), 0, 1e-7)
    assertEqualsDouble(z(0.975), 1.959963985, 1e-6)
    assertEqualsDouble(z(0.001), -3.090232306, 1e-6)
    assertEqualsDouble(z(0.999), 3.090232306, 1e-6)

  for distribution <- List(Uniform(Span.ofMillis(10), Span.ofMillis(40)), LogNormal(Span.ofMillis(36), 0.3))
  do
    test(s"the mean of $distribution is the mean of its samples"):
      assertEqualsDouble(distribution.mean.toMillis, meanAndSd(sampled(distribution))._1, 0.15)

  test("samples are quantiles, from the shortest to the longest"):
    val distribution = ofSamples(List(30, 10, 20))
    assertEquals(distribution.quantile(0), Span.ofMillis(10))
    assertEquals(distribution.quantile(0.5), Span.ofMillis(20))
    assertEquals(distribution.quantile(0.75), Span.ofMillis(25))
    assertEquals(distribution.quantile(1), Span.ofMillis(30))

  test("a single sample is a constant"):
    assertEquals(ofSamples(List(30)), Constant(Span.ofMillis(30)))

  test("the paper's links have the published quantiles"):
    val percent                               = Seq(0, 1, 5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 95, 99, 100)
    def ms(distribution: LatencyDistribution) =
      percent.map(p => (distribution.quantile(p / 100.0).toMillis * 10).round / 10.0)
    assertEquals(
      ms(Direct),
      Seq(17.8, 20.8, 22.4, 23.8, 26.1, 28.2, 31.2, 35.9, 40.1, 44.0, 47.6, 51.3, 53.8, 58.3, 85.4)
    )
    assertEquals(
      ms(Vpn),
      Seq(38.3, 53.7, 64.8, 74.2, 81.3, 87.2, 94.9, 99.4, 106.3, 113.2, 124.8, 137.9, 148.2, 165.5, 207.4)
    )
