package skein.flight

import java.io.{ByteArrayOutputStream, PrintStream}
import java.nio.charset.StandardCharsets.UTF_8
import skein.units.Span

class ProgressBoardSuite extends munit.FunSuite:
  test("a flight that started later than the first flies on, and no time beyond the flights' is told"):
    val bytes = ByteArrayOutputStream()
    val board = ProgressBoard(Vector("a", "b"), Span.ofSeconds(20), PrintStream(bytes, true, UTF_8))
    board.show(Vector(
      FlightProgress("a", Span.ofMillis(20_700), None, hasEnded = true),
      FlightProgress("b", Span.ofMillis(19_800), None)
    ))
    board.close()
    assertEquals(bytes.toString(UTF_8), "20 s of 20 s: a ended; b \n")
