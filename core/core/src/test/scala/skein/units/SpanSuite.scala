package skein.units

class SpanSuite extends munit.FunSuite:

  test("a duration is read with its unit"):
    for
      (text, nanos) <- Seq(
        "40s"    -> 40_000_000_000L,
        "1.5 s"  -> 1_500_000_000L,
        "100ms"  -> 100_000_000L,
        " 2 min" -> 120_000_000_000L,
        "250us"  -> 250_000L,
        "0 s"    -> 0L
      )
    do assertEquals(Span.parse(text).map(_.toNanos), Right(nanos), text)

  test("a bare number is not a duration, and the message suggests a unit"):
    assertEquals(Span.parse("40"), Left("expected a duration with unit, such as 40s, got '40'"))
    assertEquals(Span.parse("0.5"), Left("expected a duration with unit, such as 0.5s, got '0.5'"))

  test("negative and infinite durations, and text that is not a duration, are refused"):
    assertEquals(Span.parse("-1s"), Left("expected a duration that is not negative, got '-1s'"))
    for text <- Seq("Inf", "soon", "", "NaN", "1e400s", "99999999999d") do
      assertEquals(Span.parse(text), Left(s"expected a duration with unit, such as 100ms, got '$text'"))
