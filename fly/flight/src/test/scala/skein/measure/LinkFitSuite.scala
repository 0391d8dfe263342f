package skein.measure

import skein.signal.{LatencyProfile, LatencySampler, PacketLoss}
import skein.units.Span

class LinkFitSuite extends munit.FunSuite:
  private def profile(text: String) =
    LatencyProfile.parse(text, Left(_)).fold(error => fail(error.message), identity)

  /** Requests over a link, and their answers. */
  private def trace(text: String, count: Int, everyS: Double): RoundTripTrace =
    val link        = profile(text)
    val (to, from)  = (LatencySampler(link, 1, 2), LatencySampler(link, 1, 3))
    val (out, back) = (PacketLoss(link, 4, 5), PacketLoss(link, 4, 6))
    val trips       = Vector.tabulate(count): i =>
      val at    = Span.ofSeconds(i * everyS)
      val there = to.oneWay(at)
      val trip  = there + from.oneWay(at)
      val lost  = out.loses(at)
      Option.when(!back.loses(at) && !lost)(trip.toMillis)
    RoundTripTrace(Vector.tabulate(count)(_ * everyS), trips)

  test(
    "a fit recovers a link's losses in one direction, bursts, correlation and distribution"
  ):
    val fit = LinkFit.of(Seq(trace("loss:5%/4,correlated:2s,lognormal:100ms,0.4", 20_000, 0.2)))
    // Either direction's loss: 1 − 0.95².
    assertEqualsDouble(fit.lossShare, 0.0975, 0.012)
    assertEqualsDouble(fit.burst.get, 4.2, 0.4)
    assertEqualsDouble(fit.correlatedS.get, 2, 0.3)
    assertEqualsDouble(fit.logNormal.medianMs, 100, 4)
    assertEqualsDouble(fit.logNormal.sigma, 0.4, 0.03)
    assert(fit.distance < 0.05, s"${fit.distance}")
    assertEqualsDouble(
      profile(fit.logNormalText).impairments.head.asInstanceOf[skein.signal.Impairment.Loss].share,
      0.05,
      0.007
    )

  test("independent losses and round trips are fitted without bursts and correlation"):
    val fit = LinkFit.of(Seq(trace("loss:5%,vpn", 2000, 0.2)))
    assertEquals(fit.burst, None)
    assertEquals(fit.correlatedS, None)
    assert(fit.text("file:x").matches("loss:[0-9.]+%,file:x"), fit.text("file:x"))

  test("without losses, and with equal round trips, the profile consists only of the distribution"):
    assertEquals(LinkFit.of(Seq(trace("constant:80ms", 50, 0.1))).text("constant:80ms"), "constant:80ms")

  test(
    "in ping's output, numbers that are missing or follow the last answer are lost, repeated ones count once"
  ):
    val text = """PING 10.0.0.1 (10.0.0.1) 56(84) bytes of data.
                 |64 bytes from 10.0.0.1: icmp_seq=1 ttl=64 time=36.1 ms
                 |64 bytes from 10.0.0.1: icmp_seq=2 ttl=64 time=40.2 ms
                 |64 bytes from 10.0.0.1: icmp_seq=2 ttl=64 time=41.9 ms (DUP!)
                 |64 bytes from 10.0.0.1: icmp_seq=4 ttl=64 time=38 ms
                 |
                 |--- 10.0.0.1 ping statistics ---
                 |6 packets transmitted, 3 received, +1 duplicates, 50% packet loss, time 1000ms
                 |rtt min/avg/max/mdev = 36.1/38.1/40.2/1.6 ms""".stripMargin
    val trace = RoundTripTrace.parse(text).fold(fail(_), identity)
    assertEquals(trace.roundTripsMs, Vector(Some(36.1), Some(40.2), None, Some(38.0), None, None))
    assertEqualsDouble(trace.sentAtS.last, 1, 1e-9)

  test("ping's 16-bit numbers count on where they begin anew, and wrong ones are reported with their line"):
    def line(number: String, ms: String) = s"64 bytes from h: icmp_seq=$number ttl=64 time=$ms ms"
    val text  = Seq("65534", "0", "65535", "1", "3").map(number => line(number, s"$number.5")).mkString("\n")
    val trips = RoundTripTrace.parse(text).fold(fail(_), identity).roundTripsMs.dropWhile(_.isEmpty)
    assertEquals(trips, Vector(Some(65534.5), Some(65535.5), Some(0.5), Some(1.5), None, Some(3.5)))
    for (number, ms) <- Seq("99999999999" -> "1", "1" -> "1.2.3", "1" -> "999999999999") do
      val read = RoundTripTrace.parse(s"${line("1", "36")}\n${line(number, ms)}")
      assert(clue(read).left.exists(_.startsWith("line 2: expected a number and milliseconds")))

  test("a table is read, and a mistake in it is reported with its line"):
    assertEquals(
      RoundTripTrace.parse("time_s,rtt_ms\n0.0,36.2\n0.1,\n0.2,40\n"),
      Right(RoundTripTrace(Vector(0, 0.1, 0.2), Vector(Some(36.2), None, Some(40))))
    )
    assertEquals(
      RoundTripTrace.parse("0.0,36.2\n0.1;3\n"),
      Left(
        "line 2: expected time_s,rtt_ms, such as 0.1,36.2, or 0.1, where no answer came; got '0.1;3'"
      )
    )
    assertEquals(RoundTripTrace.parse("0.0,\n"), Left("expected round trips, got none"))
    assertEquals(RoundTripTrace.parse("1,5\n0,5\n"), Left("expected times in ascending order"))
