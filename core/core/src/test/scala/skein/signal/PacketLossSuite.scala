package skein.signal

import skein.units.*

class PacketLossSuite extends munit.FunSuite:
  private def profile(text: String) =
    LatencyProfile.parse(text, Left(_)).fold(error => fail(error.message), identity)

  private def losses(text: String, count: Int, seed: Long = 1, everyMs: Double = 10, linkSeed: Long = 7) =
    val loss = PacketLoss(profile(text), linkSeed, seed)
    Vector.tabulate(count)(i => loss.loses(Span.ofMillis(i * everyMs)))

  private def bursts(lost: Vector[Boolean]): Vector[Int] =
    lost.mkString(",").split("false").map(_.split("true", -1).length - 1).filter(_ > 0).toVector

  // Of n packets with share s, losses have a standard deviation of √(s (1 − s) n · (2 burst (1 − s) − 1)).
  for (text, share, burst) <- List(("loss:5%,none", 0.05, 1 / 0.95), ("loss:5%/4,none", 0.05, 4.0)) do
    test(s"$text loses the stated share of packets, in bursts of the stated length"):
      val lost   = losses(text, 200_000)
      val length = bursts(lost)
      assertEqualsDouble(lost.count(identity) / 200_000.0, share, 0.005)
      assertEqualsDouble(length.sum.toDouble / length.size, burst, 0.05 * burst)

  test("without loss no packet is lost"):
    assert(!losses("vpn", 1000).contains(true))
    assert(!PacketLoss(profile("loss:0%,vpn"), 1, 2).isAny)

  test("an outage loses everything for its duration, at the stated mean interval, in both directions"):
    val (here, there) = (losses("outage:1s/10s,vpn", 500_000), losses("outage:1s/10s,vpn", 500_000, seed = 2))
    assertEquals(here, there)
    assert(!here.head)
    val length = bursts(here)
    assert(length.forall(n => n == 100 || n == 99 || n == 101), length.distinct.toString)
    // 500 outages in 5,000 s; the number of Poisson-like gaps of 9 s varies by √500.
    assertEqualsDouble(length.size.toDouble, 500, 70)

  test("times of outages are stored, so that an earlier moment gives its earlier answer"):
    val loss  = PacketLoss(profile("outage:1s/10s,vpn"), 7, 1)
    val times = Vector.tabulate(1000)(i => Span.ofMillis(i * 100.0))
    val first = times.map(loss.loses)
    assertEquals(times.reverse.map(loss.loses).reverse, first)

  test("equal seeds lose equal packets, different seeds different ones"):
    assertEquals(losses("loss:5%/4,vpn", 1000), losses("loss:5%/4,vpn", 1000))
    assertNotEquals(losses("loss:5%/4,vpn", 1000), losses("loss:5%/4,vpn", 1000, seed = 2))

  test("a sender of a single packet waits a time-out, then twice as long, until the packet passes"):
    val outage                 = profile("outage:1s/60s,vpn")
    val begins                 = losses("outage:1s/60s,vpn", 300_000, everyMs = 1, linkSeed = 9).indexOf(true)
    def waits(afterMs: Double) =
      PacketLoss(outage, 9, 1).delay(Span.ofMillis(begins + afterMs), Span.ofMillis(300)).toMillis
    assertEqualsDouble(waits(-2), 0, 1e-9)
    // Tries after 0.3, 0.9 and 2.1 s.
    assertEqualsDouble(waits(800), 300, 1e-9)
    assertEqualsDouble(waits(200), 900, 1e-9)
    assertEqualsDouble(waits(50), 2100, 1e-9)

class RetransmissionSuite extends munit.FunSuite:
  test("TCP waits its minimum beyond the mean round trip, or four mean deviations if that is longer"):
    def timeout(text: String) =
      Retransmission.timeout(LatencyProfile.parse(text, Left(_)).toOption.get).toMillis
    assertEqualsDouble(timeout("none"), 200, 1e-9)
    assertEqualsDouble(timeout("constant:100ms"), 300, 1e-9)
    assertEqualsDouble(timeout("loss:5%,vpn"), LatencyProfile.vpn.meanRoundTrip.toMillis + 200, 1e-6)
    // Mean 300 ms, mean deviation 150 ms.
    assertEqualsDouble(timeout("rate:1mbit,uniform:0ms..600ms"), 300 + 4 * 150, 1e-3)

  test("each time-out is twice the previous one, up to two minutes"):
    assertEquals(Retransmission.next(Span.ofMillis(300)), Span.ofMillis(600))
    assertEquals(Retransmission.next(Span.ofSeconds(100)), Span.ofSeconds(120))
