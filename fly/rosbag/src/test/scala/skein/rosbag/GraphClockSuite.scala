package skein.rosbag

import skein.units.{Instant, Span}

/** Times are in milliseconds. */
class GraphClockSuite extends munit.FunSuite:
  private def at(ms: Double)         = Instant.Epoch + Span.ofMillis(ms)
  private def ms(time: Instant)      = time.since(Instant.Epoch).toMillis
  private def running(speed: Double) =
    val clock = GraphClock()
    for tick <- 0 to 50 do clock.add(at(5_000 + 20.0 * tick), at(900_000 + 20 / speed * tick)): Unit
    clock

  test("without clock messages, times are arrival times"):
    assertEquals(GraphClock().timeOf(at(7)), at(7))
    assertEquals(GraphClock().step, None)

  for speed <- Seq(0.5, 1.0, 10.0) do
    test(s"between messages time advances at its rate, here $speed, by at most one step"):
      val clock = running(speed)
      assertEquals(clock.step, Some(Span.ofMillis(20)))
      val last = 900_000 + 20 / speed * 50
      assertEqualsDouble(ms(clock.timeOf(at(last))), 6_000, 1e-3)
      assertEqualsDouble(ms(clock.timeOf(at(last + 8 / speed))), 6_008, 1e-3)
      assertEqualsDouble(ms(clock.timeOf(at(last + 500 / speed))), 6_020, 1e-3)

  test("while the clock stands still it is known within a step, and never runs back"):
    val clock   = running(speed = 1)
    val stopped =
      for tick <- 1 to 50 yield
        clock.add(at(6_000), at(901_000 + 100.0 * tick)): Unit
        ms(clock.timeOf(at(901_050 + 100.0 * tick)))
    assert(stopped.forall(time => time >= 6_000 && time <= 6_020), stopped)
    assertEquals(stopped, stopped.sorted)

  test(
    "time starts with the first message, and restarts if set back by over a second; late messages are ignored"
  ):
    val clock = GraphClock()
    assert(clock.add(at(5_000), at(0)))
    assert(!clock.add(at(5_020), at(20)))
    assert(!clock.add(at(5_010), at(21)))
    assertEqualsDouble(ms(clock.timeOf(at(20))), 5_020, 1e-3)
    assert(clock.add(at(100), at(40)))
    assertEqualsDouble(ms(clock.timeOf(at(40))), 100, 1e-3)
