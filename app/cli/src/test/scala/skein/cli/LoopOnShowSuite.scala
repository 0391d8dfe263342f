package skein.cli

import skein.observe.NewCommands
import skein.units.*

class LoopOnShowSuite extends munit.FunSuite:
  private var now      = Instant.Epoch + Span.ofSeconds(100)
  private var commands = Vector.empty[NewCommands]
  private var found    = 0

  private def show(findingTakes: Span = Span.Zero) = LoopOnShow(
    () => { val taken = commands; commands = Vector.empty; taken },
    () => { found += 1; now = now + findingTakes; Vector(s"finding $found") },
    () => now
  )

  override def beforeEach(context: BeforeEach): Unit =
    commands = Vector.empty
    found = 0

  test("commands and findings are sent once; a vehicle without a name is the first"):
    val shown = show()
    commands = Vector(NewCommands("", Some(20), None, Some(1)), NewCommands("b", None, Some(50), None))
    assertEquals(
      shown.json().map(ujson.read(_)),
      Some(ujson.Obj(
        "vehicles" -> ujson.Arr(
          ujson.Obj("vehicle" -> "(the first)", "ageMs" -> 20, "unanswered" -> 1),
          ujson.Obj("vehicle" -> "b", "everyMs"         -> 50)
        ),
        "findings" -> ujson.Arr("finding 1")
      ))
    )
    now = now + Span.ofMillis(100)
    assertEquals(shown.json(), None)

  test("findings are computed again after twenty times the duration of the last computation"):
    val shown                    = show(findingTakes = Span.ofSeconds(1))
    def after(seconds: Int): Int =
      now = now + Span.ofSeconds(seconds)
      commands = Vector(NewCommands("a", Some(20), None, None))
      shown.json(): Unit
      found
    assertEquals(Vector(after(0), after(10), after(9), after(1), after(10)), Vector(1, 1, 1, 2, 2))

  test("findings are also sought after the last commands, and once more at the end"):
    val shown                                         = show(findingTakes = Span.ofSeconds(1))
    def turn(seconds: Int, isCommanded: Boolean): Int =
      now = now + Span.ofSeconds(seconds)
      if isCommanded then commands = Vector(NewCommands("a", Some(20), None, None))
      shown.json(): Unit
      found
    assertEquals(Vector(turn(0, true), turn(5, true), turn(16, false), turn(30, false)), Vector(1, 1, 2, 2))
    assertEquals(turn(1, isCommanded = true), 3)
    assertEquals(turn(1, isCommanded = true), 3)
    shown.end()
    assertEquals(turn(0, isCommanded = false), 4)
    assertEquals(turn(9, isCommanded = false), 4)
