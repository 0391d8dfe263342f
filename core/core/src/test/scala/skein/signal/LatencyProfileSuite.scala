package skein.signal

import skein.units.*

class LatencyProfileSuite extends munit.FunSuite:
  import LatencyDistribution.*
  import LatencyProfile.Steady

  private val files = Map(
    "samples.txt" -> "# ms\n30\n\n10.5\n",
    "words.txt"   -> "30\nten\n",
    "empty.txt"   -> "# nothing\n"
  )

  private def parse(text: String): Either[LatencyError, LatencyProfile] =
    LatencyProfile.parse(text, path => files.get(path).toRight("no such file"))

  private def messageOf(text: String): String = parse(text).fold(_.message, p => fail(s"unexpected $p"))

  test("the predefined profiles are found by their names"):
    for profile <-
        List(LatencyProfile.none, LatencyProfile.direct, LatencyProfile.vpn, LatencyProfile.vpnMixed)
    do
      assertEquals(parse(profile.name), Right(profile))

  test("the parametric forms are read, in any unit"):
    assertEquals(parse("constant:200ms"), Right(Steady("constant:200ms", Constant(Span.ofMillis(200)))))
    assertEquals(
      parse("constant:0.2s").map(_.asInstanceOf[Steady].roundTrip),
      Right(Constant(Span.ofMillis(200)))
    )
    assertEquals(
      parse("uniform:500us..40ms"),
      Right(Steady("uniform:500us..40ms", Uniform(Span.ofMillis(0.5), Span.ofMillis(40))))
    )
    assertEquals(
      parse("lognormal:36ms,0.3"),
      Right(Steady("lognormal:36ms,0.3", LogNormal(Span.ofMillis(36), 0.3)))
    )

  test("a file of samples becomes their distribution"):
    assertEquals(
      parse("file:samples.txt"),
      Right(Steady("file:samples.txt", Quantiles(Vector(0, 1), Vector(10.5, 30))))
    )

  test("the message about an unknown name lists the possible forms"):
    assertEquals(
      messageOf("dsl"),
      "unknown latency profile \"dsl\"; expected none, direct, vpn, vpn-mixed, constant:200ms, " +
        "uniform:10ms..40ms, lognormal:36ms,0.3 or file:PATH (times are round trips), " +
        "or one of them after 'correlated:250ms,', 'rate:50mbit,', 'loss:5%,', 'loss:5%/4,', 'outage:1s/10s,' or 'reorder:2%/10ms,'"
    )

  test("the message about a mistake in a form states what was expected"):
    assertEquals(
      messageOf("constant:200"),
      "latency profile \"constant:200\": expected a time such as 200ms, got \"200\""
    )
    assertEquals(
      messageOf("uniform:40ms..10ms"),
      "latency profile \"uniform:40ms..10ms\": expected the smaller time first, got \"40ms..10ms\""
    )
    assertEquals(
      messageOf("uniform:40ms"),
      "latency profile \"uniform:40ms\": expected two times such as 10ms..40ms, got \"40ms\""
    )
    assertEquals(
      messageOf("lognormal:36ms"),
      "latency profile \"lognormal:36ms\": expected the median and the standard deviation of the logarithm " +
        "such as 36ms,0.3, got \"36ms\""
    )
    assertEquals(
      messageOf("lognormal:36ms,-1"),
      "latency profile \"lognormal:36ms,-1\": expected a standard " +
        "deviation of the logarithm from 0 to 3, got \"-1\""
    )

  test("the message about a mistake in a file states the file and the line"):
    assertEquals(
      messageOf("file:words.txt"),
      "words.txt:2: expected a round trip in ms, zero or more, got \"ten\""
    )
    assertEquals(messageOf("file:missing.txt"), "cannot read latency samples: missing.txt: no such file")
    assertEquals(
      messageOf("file:empty.txt"),
      "empty.txt: expected at least one round trip in ms, one a line; the file has none"
    )

  test("a profile may be correlated, and may have a rate"):
    val direct = LatencyProfile.direct
    val held   = LatencyProfile.Correlated("correlated:250ms,direct", direct, Span.ofMillis(250))
    val rate   = Bandwidth(50_000_000, 64_000)
    assertEquals(parse("correlated:250ms,direct"), Right(held))
    assertEquals(
      parse("rate:50mbit/64kB,direct"),
      Right(LatencyProfile.Limited("rate:50mbit/64kB,direct", direct, rate))
    )
    assertEquals(
      parse("rate:50mbit/64kB,correlated:250ms,direct"),
      Right(LatencyProfile.Limited("rate:50mbit/64kB,correlated:250ms,direct", held, rate))
    )
    assert(parse("rate:1mbit,correlated:1s,lognormal:36ms,0.3").isRight)

  test("a rate or correlation in the wrong place is reported"):
    for (text, expected) <- List(
        "rate:50mb,direct"          -> s"expected ${Bandwidth.form}, got \"50mb\"",
        "rate:50mbit"               -> "expected a rate and a profile such as 50mbit,direct, got \"50mbit\"",
        "rate:1mbit,rate:2mbit,vpn" -> "expected one rate, got \"rate:2mbit,vpn\"",
        "correlated:1s,correlated:1s,vpn" -> "expected one time constant, got \"correlated:1s,vpn\"",
        "correlated:0s,vpn"               -> "expected more than 0, got \"0s\"",
        "correlated:vpn"                  -> "expected a time and a profile such as 250ms,direct, got \"vpn\""
      )
    do assertEquals(messageOf(text), s"latency profile \"$text\": $expected")

  test("a profile's mean is that of its round trips, without the effects of correlation and rate"):
    def meanMs(text: String) =
      parse(text).map(_.meanRoundTrip.toMillis).fold(error => fail(error.message), identity)
    assertEqualsDouble(meanMs("uniform:10ms..40ms"), 25, 1e-9)
    assertEqualsDouble(meanMs("rate:1mbit,correlated:1s,constant:200ms"), 200, 1e-9)
    assertEqualsDouble(meanMs("vpn-mixed"), (40 * meanMs("vpn") + 55 * meanMs("direct")) / 95, 1e-3)

  test("rate, correlation, loss, outages and reordering may be stated in any order, each once"):
    for texts <-
        List("rate:1mbit", "correlated:1s", "loss:5%/4", "outage:1s/10s", "reorder:2%/10ms").permutations
    do
      val text    = texts.mkString(",") + ",vpn"
      val profile = parse(text).fold(error => fail(s"$text: ${error.message}"), identity)
      assertEquals(profile.name, text)
      assertEquals(profile.bandwidth, Some(Bandwidth.ofBitsPerSecond(1_000_000)))
      assertEquals(
        profile.impairments.toSet,
        Set(
          Impairment.Loss(0.05, 4),
          Impairment.Outage(Span.ofSeconds(1), Span.ofSeconds(10)),
          Impairment.Reordering(0.02, Span.ofMillis(10))
        )
      )
      assertEquals(profile.meanRoundTrip, LatencyProfile.vpn.meanRoundTrip)

  test("losses without a stated burst length are independent"):
    assertEquals(parse("loss:20%,vpn").map(_.impairments), Right(Vector(Impairment.Loss(0.2, 1.25))))

  test("the message about an invalid loss, outage or reordering states what was expected"):
    val share =
      "expected a share from 0% to 90% such as 5%, or with a mean length of bursts such as 5%/4, got "
    for (text, expected) <- List(
        "loss:5%"          -> "expected a share and a profile such as 5%,vpn or 5%/4,vpn, got \"5%\"",
        "loss:5,vpn"       -> s"$share\"5\"",
        "loss:95%,vpn"     -> s"$share\"95%\"",
        "loss:-1%,vpn"     -> s"$share\"-1%\"",
        "loss:NaN%,vpn"    -> s"$share\"NaN%\"",
        "loss:50%/1.5,vpn" ->
          "expected bursts of 2.00 packets, which independent losses have, to 10000, got \"50%/1.5\"",
        "loss:1%,loss:2%,vpn" -> "expected one loss, got \"loss:2%,vpn\"",
        "reorder:2%,vpn"      -> "expected a share and an additional delay such as 2%/10ms, got \"2%\"",
        "reorder:2%/0ms,vpn"  -> "expected a share and an additional delay such as 2%/10ms, got \"2%/0ms\"",
        "reorder:2%/10ms"   -> "expected a share, a delay and a profile such as 2%/10ms,vpn, got \"2%/10ms\"",
        "outage:1s"         -> "expected two times and a profile such as 1s/10s,vpn, got \"1s\"",
        "outage:1s,vpn"     -> "expected two times such as 1s/10s, got \"1s\"",
        "outage:10s/1s,vpn" ->
          "expected outages of more than 0, and longer times from one to the next, got \"10s/1s\"",
        "outage:1s/9s,rate:1mbit,outage:1s/9s,vpn" ->
          "expected one outage, got \"rate:1mbit,outage:1s/9s,vpn\""
      )
    do assertEquals(messageOf(text), s"latency profile \"$text\": $expected")
