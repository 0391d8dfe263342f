package skein.units

class TimeSuite extends munit.FunSuite:

  test("a span is exact to the nanosecond over a day"):
    val start = Instant.ofNanos(1_790_000_000_000_000_000L)
    val later = start + Span.ofSeconds(86400.000000001)
    assertEquals(later.since(start).toNanos, 86400000000001L)

  test("milliseconds round to the nearest nanosecond"):
    assertEquals(Span.ofMillis(0.0000006).toNanos, 1L)
    assertEquals(Span.ofMillis(36.8).toSeconds, 0.0368)
