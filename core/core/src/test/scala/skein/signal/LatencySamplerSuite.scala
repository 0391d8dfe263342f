package skein.signal

import skein.units.*

class LatencySamplerSuite extends munit.FunSuite:

  private def delaysMs(profile: LatencyProfile, linkSeed: Long, lineSeed: Long, count: Int): Vector[Double] =
    val sampler = LatencySampler(profile, linkSeed, lineSeed)
    Vector.tabulate(count)(i => sampler.oneWay(Span.ofMillis(100.0 * i)).toMillis)

  test("a one-way delay is half of a round trip"):
    val constant = LatencyProfile.Steady("constant:200ms", LatencyDistribution.Constant(Span.ofMillis(200)))
    assertEquals(delaysMs(constant, 1, 2, 3), Vector(100.0, 100.0, 100.0))

  test("equal seeds give equal delays, different line seeds give different ones"):
    val first = delaysMs(LatencyProfile.vpnMixed, 1, 2, 2000)
    assertEquals(delaysMs(LatencyProfile.vpnMixed, 1, 2, 2000), first)
    assertNotEquals(delaysMs(LatencyProfile.vpnMixed, 1, 3, 2000), first)

  test("the reordered share is late by its time, the others are not"):
    val profile = LatencyProfile.parse("reorder:2%/10ms,constant:200ms", Left(_)).toOption.get
    val delays  = delaysMs(profile, 1, 2, 50_000)
    assertEquals(delays.toSet, Set(100.0, 110.0))
    // Four standard deviations of a binomial count.
    assertEqualsDouble(delays.count(_ == 110).toDouble, 1000, 125)

  test("without a network there is no delay"):
    assertEquals(delaysMs(LatencyProfile.none, 1, 2, 2), Vector(0.0, 0.0))

  test("over a long time vpn-mixed has the published mean and quantiles, within 5 ms"):
    val roundTrips = delaysMs(LatencyProfile.vpnMixed, 1, 2, 400_000).map(_ * 2).sorted
    assertEqualsDouble(roundTrips.sum / roundTrips.size, 65.1, 2.5)
    for (p, ms) <- List(0.1 -> 25.9, 0.3 -> 37.4, 0.5 -> 50.7, 0.7 -> 86.5, 0.9 -> 120.4, 0.99 -> 159.5) do
      assertEqualsDouble(roundTrips((p * roundTrips.size).toInt), ms, 5, s"quantile at $p")

  test("all lines of a link are busy and quiet simultaneously, in long stretches"):
    val windows = List(2L, 3L).map: lineSeed =>
      delaysMs(LatencyProfile.vpnMixed, 1, lineSeed, 36_000).grouped(50).map(_.sum / 50 > 35).toVector
    val List(first, second) = windows: @unchecked
    val disagree            = first.zip(second).count(_ != _)
    val changes             = first.zip(first.tail).count(_ != _)
    // An hour has about 76 stretches; a window that spans a change may fall on either side.
    assert(disagree < 20, s"$disagree of ${first.size} windows disagree")
    assert(changes > 30 && changes < 130, s"$changes changes in an hour")

  private def roundTripsMs(profile: LatencyProfile): Vector[Double] =
    val (there, back) = (LatencySampler(profile, 1, 2), LatencySampler(profile, 1, 3))
    Vector.tabulate(50_000): i =>
      val sent    = Span.ofMillis(200.0 * i)
      val arrived = there.oneWay(sent)
      (arrived + back.oneWay(sent + arrived)).toMillis

  /** Largest difference between the sampled and the exact distribution function. */
  private def distance(samplesMs: Vector[Double], profile: LatencyDistribution): Double =
    val sorted = samplesMs.sorted
    (0 to 100).map: percent =>
      val ms = profile.quantile(percent / 100.0).toMillis
      math.abs(sorted.count(_ <= ms).toDouble / sorted.size - percent / 100.0)
    .max

  test("round trips over a correlated link spread as measured, over an independent link they spread less"):
    for (name, measured) <- List("direct" -> LatencyDistribution.Direct, "vpn" -> LatencyDistribution.Vpn) do
      def profile(text: String) =
        LatencyProfile.parse(text, _ => Left("")).fold(e => fail(e.message), identity)
      val held   = distance(roundTripsMs(profile(s"correlated:1s,$name")), measured)
      val halves = distance(roundTripsMs(profile(name)), measured)
      assert(held < 0.02, s"$name: $held")
      assert(halves > 0.08, s"$name: $halves")

  test("the correlation of two delays decreases by e in the stated time, with an unchanged distribution"):
    val uniform = LatencyDistribution.Uniform(Span.Zero, Span.ofMillis(200))
    val profile =
      LatencyProfile.Correlated("", LatencyProfile.Steady("", uniform), over = Span.ofMillis(300))
    val delays               = delaysMs(profile, 1, 2, 200_000)
    val mean                 = delays.sum / delays.size
    def covariance(lag: Int) =
      delays.zip(delays.drop(lag)).map((a, b) => (a - mean) * (b - mean)).sum / (delays.size - lag)
    assertEqualsDouble(mean, 50, 1)
    assertEqualsDouble(covariance(0), 100.0 * 100.0 / 12, 20)
    assertEqualsDouble(covariance(3) / covariance(0), math.exp(-1), 0.02)
    assertEqualsDouble(covariance(6) / covariance(0), math.exp(-2), 0.02)

  test("both directions and all connections of a correlated link have equal delays at one moment"):
    val profile = LatencyProfile.Correlated("", LatencyProfile.vpn, over = Span.ofSeconds(1))
    assertEquals(delaysMs(profile, 1, 2, 500), delaysMs(profile, 1, 3, 500))
    assertNotEquals(delaysMs(profile, 1, 2, 500), delaysMs(profile, 2, 2, 500))
