package skein.link

import java.util.concurrent.atomic.LongAdder
import skein.signal.{LatencyDistribution, LatencyProfile, LatencySampler, SplitMix64}
import skein.units.*

class DeliverySuite extends munit.FunSuite:
  private val halfSecondEachWay =
    LatencyProfile.Steady("constant:1s", LatencyDistribution.Constant(Span.ofSeconds(1)))

  private def ms(value: Double): Span = Span.ofMillis(value)

  private def delivery(
      latency: LatencyProfile = halfSecondEachWay,
      faults: Faults = Faults.none,
      opened: Span = Span.Zero,
      stalls: LongAdder = LongAdder()
  ): Delivery =
    Delivery(
      LatencySampler(latency, 1, 2),
      faults.stalls(3),
      faults.breakOf(opened, 3),
      stalls
    )

  private def stall(at: Double, lasts: Double) = TimedFault(ms(at), Fault.Stall(ms(lasts)))

  test("bytes come out after half of the round trip"):
    assertEquals(delivery().due(ms(20)), Some(ms(520)))

  test("no bytes overtake older ones, and each waits no longer than its own delay or the one before"):
    val line    = delivery(LatencyProfile.vpn)
    val sampler = LatencySampler(LatencyProfile.vpn, 1, 2)
    var before  = Span.Zero
    for i <- 0 until 1000 do
      val now = ms(i * 10.0)
      val due = line.due(now).get
      assertEquals(due, before.max(now + sampler.oneWay(now)))
      before = due

  test("bytes due within a stall come out at its end, others are unaffected"):
    val stalls = LongAdder()
    val line   = delivery(faults = Faults(List(stall(1000, 200))), stalls = stalls)
    val dues   = List(400, 500, 650, 699, 700, 900).map(now => line.due(ms(now)).get)
    assertEquals(dues, List(900, 1200, 1200, 1200, 1200, 1400).map(ms(_)))
    assertEquals(stalls.sum, 1L)

  test("overlapping or consecutive stalls delay until the last has ended"):
    val line = delivery(faults = Faults(List(stall(1000, 200), stall(1100, 50), stall(1200, 100))))
    assertEquals(line.due(ms(600)), Some(ms(1300)))

  test("bytes in transit when the link resets are lost, and the connection breaks then"):
    val line = delivery(faults = Faults(List(TimedFault(ms(1000), Fault.Reset))))
    assertEquals(line.due(ms(499)), Some(ms(999)))
    assertEquals(line.due(ms(500)), None)
    assertEquals(line.breaksAt, Some(ms(1000)))

  test("a silence loses bytes immediately and breaks the connection at its end"):
    val line = delivery(faults = Faults(List(TimedFault(ms(1000), Fault.Silence(ms(300))))))
    assertEquals(line.due(ms(600)), None)
    assertEquals(line.breaksAt, Some(ms(1300)))

  test("a connection opened after a reset lives until the next"):
    val faults = Faults(List(TimedFault(ms(2000), Fault.Reset), TimedFault(ms(1000), Fault.Reset)))
    assertEquals(delivery(faults = faults, opened = ms(999)).breaksAt, Some(ms(1000)))
    assertEquals(delivery(faults = faults, opened = ms(1000)).breaksAt, Some(ms(2000)))
    assertEquals(delivery(faults = faults, opened = ms(2000)).breaksAt, None)

  test("a connection opened within a silence is lost until the silence ends"):
    val faults = Faults(List(TimedFault(ms(1000), Fault.Silence(ms(300))), TimedFault(ms(2000), Fault.Reset)))
    val line   = delivery(faults = faults, opened = ms(1100))
    assertEquals(line.due(ms(1100)), None)
    assertEquals(line.breaksAt, Some(ms(1300)))
    assertEquals(delivery(faults = faults, opened = ms(1300)).breaksAt, Some(ms(2000)))

  test("random stalls are in order, have the requested frequency and length, and are equal for equal seeds"):
    val faults = Faults(stallEvery = Some(Span.ofSeconds(10)), stallLasts = Span.ofSeconds(2))
    val stalls = faults.stalls(7).take(10_000).toVector
    assertEquals(faults.stalls(7).take(10_000).toVector, stalls)
    assertNotEquals(faults.stalls(8).take(10_000).toVector, stalls)
    assert(stalls.map(_.from).sliding(2).forall(pair => pair(0) <= pair(1)))
    assertEqualsDouble(stalls.last.from.toSeconds / stalls.size, 10, 0.3)
    assertEqualsDouble(stalls.map(s => (s.until - s.from).toSeconds).sum / stalls.size, 2, 0.1)

  test("random and scheduled stalls are merged by time"):
    val faults = Faults(List(stall(5000, 1), stall(1, 1)), stallEvery = Some(Span.ofSeconds(1)))
    val starts = faults.stalls(7).map(_.from).take(100).toVector
    assertEquals(starts, starts.sorted)
    assert(starts.contains(ms(5000)) && starts.contains(ms(1)))

  test("random resets end connections after the requested mean time, and the earlier fault wins"):
    val faults = Faults(resetEvery = Some(Span.ofSeconds(20)))
    val random = SplitMix64(1)
    val lives  = List.fill(2000)(Span.ofSeconds(random.nextDouble() * 1000)).map: opened =>
      (faults.breakOf(opened, random.nextLong()).get.at - opened).toSeconds
    assertEqualsDouble(lives.sum / lives.size, 20, 1.5)
    val both = faults.copy(schedule = List(TimedFault(ms(0.001), Fault.Silence(ms(1)))))
    assertEquals(both.breakOf(Span.Zero, 1), Some(TimedFault(ms(0.001), Fault.Silence(ms(1)))))
