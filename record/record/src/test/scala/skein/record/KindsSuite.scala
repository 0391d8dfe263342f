package skein.record

/** Loops and clocks by their names in commands and recordings. */
class KindsSuite extends munit.FunSuite:

  test("every clock and every loop is found by its name"):
    for kind <- ClockKind.values do assertEquals(ClockKind.parse(kind.label), Right(kind))
    for kind <- LoopKind.values do assertEquals(LoopKind.parse(kind.label), Right(kind))

  test("an unknown name is refused with the list of the known ones"):
    assertEquals(ClockKind.parse("Real"), Left("expected real or virtual, got 'Real'"))
    assertEquals(
      LoopKind.parse("streams"),
      Left("no loop 'streams': expected one of paused, sequential, futures, stream, predictive, plan")
    )

  test("parameters belong to the word before their first full stop"):
    val heading = Samples.heading.copy(parameters =
      Seq(
        ParameterRow("ring.m", "8"),
        ParameterRow("ring.at.s", "2"),
        ParameterRow("other.m", "1"),
        ParameterRow("ring", "0")
      )
    )
    assertEquals(heading.parametersOf("ring"), Map("m" -> "8", "at.s" -> "2"))
