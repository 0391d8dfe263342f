package skein.signal

import skein.units.*

class LatencySamplerSuite extends munit.FunSuite:

  private def delaysMs(profile: LatencyProfile, linkSeed: Long, lineSeed: Long, count: Int): Vector[Double] =
    val sampler = LatencySampler(profile, linkSeed, lineSeed)
    Vector.tabulate(count)(i => sampler.oneWay(Span.ofMillis(100.0 * i)).toMillis)

  test("one direction takes half of a round trip"):
    val constant = LatencyProfile.Steady("constant:200ms", LatencyDistribution.Constant(Span.ofMillis(200)))
    assertEquals(delaysMs(constant, 1, 2, 3), Vector(100.0, 100.0, 100.0))

  test("the same seeds give the same delays, another line seed gives others"):
    val first = delaysMs(LatencyProfile.vpnMixed, 1, 2, 2000)
    assertEquals(delaysMs(LatencyProfile.vpnMixed, 1, 2, 2000), first)
    assertNotEquals(delaysMs(LatencyProfile.vpnMixed, 1, 3, 2000), first)

  test("without a network there is no delay"):
    assertEquals(delaysMs(LatencyProfile.none, 1, 2, 2), Vector(0.0, 0.0))

  test("over a long time vpn-mixed has the published mean and quantiles within 5 ms"):
    val roundTrips = delaysMs(LatencyProfile.vpnMixed, 1, 2, 2_000_000).map(_ * 2).sorted
    assertEqualsDouble(roundTrips.sum / roundTrips.size, 65.1, 2.5)
    for (p, ms) <- List(0.1 -> 25.9, 0.3 -> 37.4, 0.5 -> 50.7, 0.7 -> 86.5, 0.9 -> 120.4, 0.99 -> 159.5) do
      assertEqualsDouble(roundTrips((p * roundTrips.size).toInt), ms, 5, s"quantile at $p")

  test("all lines of a link are busy and quiet at the same times, in long stretches"):
    val windows = List(2L, 3L).map: lineSeed =>
      delaysMs(LatencyProfile.vpnMixed, 1, lineSeed, 36_000).grouped(50).map(_.sum / 50 > 35).toVector
    val List(first, second) = windows: @unchecked
    val disagree            = first.zip(second).count(_ != _)
    val changes             = first.zip(first.tail).count(_ != _)
    // An hour has about 76 stretches; a window that spans a change may fall on either side.
    assert(disagree < 20, s"$disagree of ${first.size} windows disagree")
    assert(changes > 30 && changes < 130, s"$changes changes in an hour")
