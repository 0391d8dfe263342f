package skein.signal

import org.scalacheck.Gen
import org.scalacheck.Prop.{forAll, forAllNoShrink}
import skein.units.*

class ClockAlignmentLaws extends munit.ScalaCheckSuite:

  private val trueOffset = Span.ofSeconds(12345.678)

  private val legs =
    Gen.choose(1, 50).flatMap(n => Gen.listOfN(n, Gen.zip(Gen.choose(8.0, 100.0), Gen.choose(8.0, 100.0))))

  private def reading(at: Int, legsMs: (Double, Double)) =
    val validAt = Instant.ofNanos(100_000_000L * at)
    val sampled = validAt + trueOffset
    Stamped((), validAt, sampled - Span.ofMillis(legsMs._1), sampled + Span.ofMillis(legsMs._2))

  private def aligned(legs: List[(Double, Double)]) =
    val readings = legs.zipWithIndex.map((leg, at) => reading(at, leg))
    readings.tail.foldLeft(ClockAlignment.of(readings.head))(_.updated(_))

  property("the true offset lies within the stated uncertainty, whatever the asymmetry of the delays"):
    forAll(legs): legs =>
      val alignment = aligned(legs)
      math.abs((alignment.offset - trueOffset).toNanos) <= alignment.uncertainty.toNanos + 1

  property(
    "the uncertainty is the distance to the farther bound, at least half of the distance between the bounds"
  ):
    forAll(legs): legs =>
      val alignment = aligned(legs)
      val width     = alignment.upper - alignment.lower
      alignment.uncertainty * 2 >= width && alignment.uncertainty <= width

  property("more readings never widen the bounds by more than the possible drift of the clocks"):
    forAll(legs): legs =>
      val drifted       = Span.ofMillis((legs.size * 100 + 200) * ClockAlignment.MaxDrift) * 2
      val (first, last) = (aligned(legs.take(1)), aligned(legs))
      last.upper - last.lower <= first.upper - first.lower + drifted

  test("readings after the simulator was paused restart the estimate"):
    val before  = reading(0, (10, 10))
    val after   = reading(1, (10, 10)).copy(validAt = before.validAt + Span.ofMillis(1))
    val aligned = ClockAlignment.of(before).updated(after)
    assertEquals(
      (aligned.lower, aligned.upper),
      (ClockAlignment.of(after).lower, ClockAlignment.of(after).upper)
    )
    assertEquals((aligned.restarts, aligned.standsStill), (1, false))

  test("a stop of the simulator's clock is noticed at the next reading, and so is its resumption"):
    val legs    = (10.0, 10.0)
    val before  = reading(0, legs)
    val paused  = (1 to 3).map(at => reading(at, legs).copy(validAt = before.validAt))
    val resumed = (4 to 5).map(at => reading(at, legs)).map(seen =>
      seen.copy(validAt = seen.validAt - Span.ofMillis(300))
    )
    val states = (paused ++ resumed).scanLeft(ClockAlignment.of(before))(_.updated(_))
    assertEquals(states.map(_.standsStill), Seq(false, true, true, true, false, false))
    assertEquals(states.last.restarts, 1)
    assertEquals(states.last.offset, trueOffset + Span.ofMillis(300))

  test("a sample that is reported twice within a tick of the simulator's clock is not a stop"):
    val before            = reading(0, (10, 10))
    val first             = ClockAlignment.of(before)
    def told(after: Span) =
      val sent = before.receivedAt + after
      first.updated(before.copy(sentAt = sent, receivedAt = sent + Span.ofMillis(1)))
    assert(!told(ClockAlignment.Tick).standsStill)
    assert(told(ClockAlignment.Tick + Span.ofNanos(1)).standsStill)

  for (link, boundMs) <- Seq(LatencyProfile.direct -> 2.0, LatencyProfile.vpn -> 5.0) do
    test(
      s"over ${link.name} the estimate is, and stays, within $boundMs ms after 5 s at 20 readings per second"
    ):
      for seed <- 1L to 100L do
        val (there, back) = (LatencySampler(link, seed, 2 * seed), LatencySampler(link, seed, 2 * seed + 1))
        def seen(at: Int) =
          val since   = Span.ofMillis(50.0 * at)
          val sentAt  = Instant.Epoch + trueOffset + since
          val sampled = sentAt + there.oneWay(since)
          Stamped((), sampled - trueOffset, sentAt, sampled + back.oneWay(since))
        val states = (1 to 1200).map(seen).scanLeft(ClockAlignment.of(seen(0)))(_.updated(_))
        for aligned <- states.drop(100) do
          val offMs = (aligned.offset - trueOffset).toMillis
          assert(math.abs(offMs) < boundMs, s"seed $seed: off by $offMs ms")
          assertEquals(aligned.restarts, 0, s"seed $seed")

  test(
    "clocks whose rates differ by 50 parts per million stay aligned over ten minutes, even without a network"
  ):
    for
      legMs <- Seq(0.01, 9.0)
      rate  <- Seq(50e-6, -50e-6)
    do
      val start  = reading(0, (legMs, legMs))
      val states = (1 to 12000).map: at =>
        val passed = Span.ofMillis(50.0 * at)
        val drift  = Span.ofMillis(50.0 * at * rate)
        Stamped((), start.validAt + passed, start.sentAt + passed + drift, start.receivedAt + passed + drift)
      .scanLeft(ClockAlignment.of(start))(_.updated(_))
      assertEquals(states.last.restarts, 0, s"$legMs ms, rate $rate")
      val trueNow = trueOffset + Span.ofMillis(600_000 * rate)
      assertEqualsDouble((states.last.offset - trueNow).toMillis, 0, 0.5)
      assert(states.last.lower <= trueNow && trueNow <= states.last.upper, s"$legMs ms, rate $rate")

  test("between readings both bounds widen by the allowed drift, and by no more"):
    val fast  = ClockAlignment.of(reading(0, (1, 1)))
    val slow  = reading(1000, (100, 100))
    val after = fast.updated(slow)
    val slack = Span.ofNanos(
      math.ceil(slow.receivedAt.since(reading(0, (1, 1)).receivedAt).toNanos * ClockAlignment.MaxDrift).toLong
    )
    assertEquals((after.lower, after.upper), (fast.lower - slack, fast.upper + slack))

  private def ms(at: Double) = Instant.Epoch + Span.ofMillis(at)

  test(
    "a late answer from a former run of the simulator counts as older than the new run, whatever its " +
      "time stamp"
  ):
    // Of torture's seed 4876: the second run's clock is 19.96 s behind the first's.
    def answer(validMs: Double, sentMs: Double, receivedMs: Double) =
      Stamped((), ms(validMs), ms(sentMs), ms(receivedMs))
    val before = answer(21659.429, 1700, 1700)
    val next   = answer(1900, 1900, 1900)
    val late   = answer(21559.429, 1600, 1988.846)
    val known  = ClockAlignment.of(before).updated(next)
    assert(ClockAlignment.of(next).isNewer(late, next), "two readings alone cannot tell")
    assert(known.isNewer(next, late) && !known.isNewer(late, next))
    assert(known.isNewer(before, late) && !known.isNewer(late, before))
    assert(!known.isNewer(next, next), "nothing is newer than itself, be it answered at once")
    assert(known.isOfFormerRun(late) && !known.isOfFormerRun(next))
    assertEquals(known.updated(late), known)
    assertEquals((known.restarts, known.updated(late).updated(answer(2000, 2000, 2000)).restarts), (1, 1))

  property("the newer of two readings is known across restarts, whatever the order of arrival"):
    val restarts = Gen.listOfN(3, Gen.choose(1000.0, 20000.0).flatMap(jump => Gen.oneOf(jump, -jump)))
    forAllNoShrink(Gen.listOfN(40, Gen.zip(Gen.choose(0.0, 300.0), Gen.choose(0.0, 300.0))), restarts):
      (legs, jumps) =>
        val aheadMs  = jumps.scanLeft(0.0)(_ + _)
        val readings = legs.zipWithIndex.map: (leg, at) =>
          val sampledMs = 1000 + 100.0 * at
          val stamped   =
            Stamped(at, ms(sampledMs + aheadMs(at / 10)), ms(sampledMs - leg._1), ms(sampledMs + leg._2))
          if at % 10 == 0 then stamped.copy(receivedAt = ms(sampledMs)) else stamped
        val arrived = readings.sortBy(_.receivedAt.toNanos)
        val known   = arrived.tail.foldLeft(ClockAlignment.of(arrived.head))(_.updated(_))
        val wrong   =
          for one <- readings; other <- readings if known.isNewer(one, other) != one.value > other.value
          yield (one, other)
        wrong == Nil

  test("the last few former runs are stored"):
    def first(run: Int) = Stamped((), ms(100.0 * run - 5000.0 * run), ms(100.0 * run), ms(100.0 * run + 1))
    val runs            = (0 to ClockAlignment.FormerRuns + 1).map(first)
    val known           = runs.tail.foldLeft(ClockAlignment.of(runs.head))(_.updated(_))
    assertEquals(known.former.size, ClockAlignment.FormerRuns)
    assert(known.former.forall(_.former.isEmpty))
    assertEquals(known.restarts, ClockAlignment.FormerRuns + 1)
    assertEquals(
      runs.map(known.isOfFormerRun),
      false +: Vector.fill(ClockAlignment.FormerRuns)(true) :+ false
    )
