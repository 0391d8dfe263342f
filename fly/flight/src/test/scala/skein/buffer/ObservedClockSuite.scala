package skein.buffer

import skein.signal.Stamped
import skein.units.*

class ObservedClockSuite extends munit.FunSuite:
  private val began = Instant.Epoch + Span.ofSeconds(1000)

  private def ms(time: Double) = began + Span.ofMillis(time)

  /** A simulator's clock that ran at a constant speed, except for a pause. */
  private final case class Simulator(
      speed: Double,
      stopMs: Double = 1e9,
      startMs: Double = 1e9,
      stepMs: Double = 0
  ):
    def shows(atMs: Double): Instant =
      val ran  = atMs.min(stopMs) + (atMs - startMs).max(0)
      val at   = ran * speed
      val last = if stepMs == 0 then at else math.floor(at / stepMs) * stepMs
      Instant.Epoch + Span.ofMillis(last)

    /** Readings every 10 ms, with a round trip of 0.4 ms. */
    def read(untilMs: Double): ObservedClock =
      val readings = (0 to untilMs.toInt by 10).map: at =>
        Stamped((), shows(at + 0.2), ms(at), ms(at + 0.4))
      readings.tail.foldLeft(ObservedClock.of(readings.head))(_.updated(_))

    def offMs(untilMs: Double, laterMs: Double): Double =
      val known = read(untilMs).shows(ms(untilMs + laterMs)).getOrElse(fail("unknown"))
      known.since(shows(untilMs + laterMs)).toMillis

  for speed <- Seq(1.0, 0.2, 3, 20) do
    test(
      s"a clock $speed times as fast as the machine's is known to half a round trip until the next reading"
    ):
      for until <- Seq(200.0, 1500, 5000); later <- Seq(0.4, 5, 10) do
        val off = Simulator(speed).offMs(until, later)
        assert(math.abs(off) <= 0.2 * speed.max(1) + 0.01, s"$off ms off, $later ms after a reading")

  test("a clock that advances in steps is known to a step"):
    for until <- Seq(200.0, 1500, 5000); later <- Seq(0.4, 5, 10) do
      val off = Simulator(1, stepMs = 3).offMs(until, later)
      assert(math.abs(off) <= 3.2, s"$off ms off, $later ms after a reading")

  test("a stopped clock shows its last time from the second reading on, and reaches no later time"):
    val stopped = Simulator(1, stopMs = 1003)
    assert(stopped.offMs(1010, 10) <= 10.1)
    assertEqualsDouble(stopped.offMs(1020, 10), 0, 1e-6)
    assertEquals(stopped.read(1020).comesTo(stopped.shows(1020) + Span.ofSeconds(1)), None)

  test("a restarted clock is followed from the first reading on"):
    val resumed = Simulator(1, stopMs = 1003, startMs = 2006)
    assertEqualsDouble(resumed.offMs(2010, 10), 0, 0.21)
    assertEqualsDouble(resumed.offMs(3000, 10), 0, 0.21)

  test("the clock is unknown from 100 ms after the last reading on"):
    assertEquals(Simulator(1).read(1000).shows(ms(1100.5)), None)
    assert(Simulator(1).read(1000).shows(ms(1100.3)).isDefined)

  test("the predicted moment of a simulated time is when the clock shows that time"):
    for speed <- Seq(1.0, 0.3, 7); ahead <- Seq(0.001, 3, 90) do
      val clock = Simulator(speed).read(2000)
      val time  = clock.shows(ms(2000.4)).get + Span.ofMillis(ahead)
      val at    = clock.comesTo(time).get
      val shown = clock.shows(at)
      assert(
        shown.forall(now => now >= time && now.since(time) <= Span.ofNanos(20)),
        s"$speed: $shown, $time"
      )
