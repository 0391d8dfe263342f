package skein.signal

import skein.units.*

class FastestMessageSuite extends munit.FunSuite:
  private def ms(millis: Double) = Span.ofMillis(millis)

  /** The state after messages every 20 ms with these delays, ms, whose header's clock is 1 h behind. */
  private def after(delays: Seq[Double]): FastestMessage =
    val received = delays.zipWithIndex.map: (delay, index) =>
      val validAt = Instant.ofNanos(0) + ms(20.0 * index)
      (validAt, validAt + ms(3_600_000 + delay))
    val first = received.head
    received.tail.foldLeft(FastestMessage(first._2.since(first._1), first._2)):
      case (fastest, (validAt, at)) => fastest.updated(validAt, at)

  test("the offset is that of the fastest message"):
    val fastest = after(Seq(9, 4, 1.5, 30, 7))
    assertEquals(fastest.offset, ms(3_600_001.5))

  test("slow messages do not change the offset, but the clocks' drift does with time"):
    val slow = after(1.0 +: Vector.fill(500)(5.0))
    assertEquals(slow.offset, ms(3_600_001))
    // 100 parts in a million make 5 ms of 50 s.
    val drifted = after(1.0 +: Vector.fill(2600)(6.0))
    assertEquals(drifted.offset, ms(3_600_006))

  test("estimation restarts after a clock has stood still or was set back"):
    assertEquals(after(Seq(1, 2, 5_000)).offset, ms(3_605_000))
    assertEquals(after(Seq(1, 2, -50_000)).offset, ms(3_550_000))

  test(
    "readings with estimated times never contradict the clocks' alignment once the fastest delay is " +
      "nearly known"
  ):
    val random  = scala.util.Random(1)
    val delays  = Vector.fill(3000)(2 + 3 * -math.log(1 - random.nextDouble()))
    var fastest =
      FastestMessage(ms(3_600_000 + delays.head), Instant.ofNanos(0) + ms(3_600_000 + delays.head))
    var alignment = Option.empty[ClockAlignment]
    for (delay, index) <- delays.zipWithIndex do
      val validAt = Instant.ofNanos(0) + ms(20.0 * index)
      val at      = validAt + ms(3_600_000 + delay)
      fastest = fastest.updated(validAt, at)
      val reading = Stamped((), validAt, fastest.sentAt(validAt, at), at)
      assert(reading.sentAt <= at)
      alignment = Some(alignment.fold(ClockAlignment.of(reading))(_.updated(reading)))
    assertEquals(alignment.get.restarts, 0)
    assertEqualsDouble(alignment.get.offset.toMillis, 3_600_002, 5)
