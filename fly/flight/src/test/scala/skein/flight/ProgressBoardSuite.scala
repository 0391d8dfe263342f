package skein.flight

import java.io.{ByteArrayOutputStream, PrintStream}
import java.nio.charset.StandardCharsets.UTF_8
import skein.units.Span

class ProgressBoardSuite extends munit.FunSuite:
  test(
    "when one of two flights has ended, progress shows the other, and no time beyond the flights' duration"
  ):
    val bytes = ByteArrayOutputStream()
    val board = ProgressBoard(Vector("a", "b"), Span.ofSeconds(20), PrintStream(bytes, true, UTF_8))
    board.show(Vector(
      FlightProgress("a", Span.ofMillis(20_700), None, hasEnded = true),
      FlightProgress("b", Span.ofMillis(19_800), None)
    ))
    board.close()
    assertEquals(bytes.toString(UTF_8), "20 s of 20 s: a ended; b \n")

  test("if time passes in steps, progress shows the simulator's time, every 10 s of the controller's time"):
    val bytes = ByteArrayOutputStream()
    val board = ProgressBoard(Vector("paused"), Span.ofSeconds(15), PrintStream(bytes, true, UTF_8))
    for s <- Seq(10, 14, 20, 30) do
      board.show(Vector(FlightProgress(
        "paused",
        Span.ofSeconds(s),
        None,
        stepped = Some(Span.ofSeconds(s * 0.2))
      )))
    board.close()
    assertEquals(
      bytes.toString(UTF_8),
      "2 s of 15 s: paused \n4 s of 15 s: paused \n6 s of 15 s: paused \n"
    )
