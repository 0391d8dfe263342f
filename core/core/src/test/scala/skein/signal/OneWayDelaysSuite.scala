package skein.signal

import skein.units.*

class OneWayDelaysSuite extends munit.FunSuite:
  private val skew = Span.ofSeconds(500)

  private def reading(thereMs: Double, backMs: Double) =
    val sentAt  = Instant.Epoch + Span.ofSeconds(3)
    val sampled = sentAt + Span.ofMillis(thereMs)
    Stamped((), sampled + skew, sentAt, sampled + Span.ofMillis(backMs))

  private def delays(legs: (Double, Double)*) =
    val readings = legs.map(reading)
    readings.tail.foldLeft(OneWayDelays.of(readings.head))(_.updated(_))

  test("the means are those of the first readings, and include the offset of the clocks"):
    val seen = delays((10, 40), (20, 50), (60, 60))
    assertEqualsDouble((seen.toSimulator - skew).toMillis, 30, 1e-5)
    assertEqualsDouble((seen.fromSimulator + skew).toMillis, 50, 1e-5)
    assertEqualsDouble(seen.roundTrip.toMillis, 80, 1e-5)

  test("the means follow a link that becomes busy: after 100 readings the quiet time has little weight"):
    val seen = delays(Seq.fill(1000)((10.0, 10.0)) ++ Seq.fill(100)((50.0, 50.0))*)
    assertEqualsDouble((seen.toSimulator - skew).toMillis, 50, 2)

  test("half of a late answer's excess delay is attributed to each direction"):
    val sentAt = Instant.Epoch + Span.ofSeconds(9)
    val seen   = delays((30, 50))
    assertEquals(seen.expectedArrival(sentAt), sentAt + skew + Span.ofMillis(30))
    assertEquals(seen.arrivalGiven(sentAt, sentAt + Span.ofMillis(100)), sentAt + skew + Span.ofMillis(40))
