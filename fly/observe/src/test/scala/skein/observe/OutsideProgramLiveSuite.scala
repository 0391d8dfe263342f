package skein.observe

import scala.annotation.tailrec
import skein.testing.Waiting
import skein.units.Span

/** Programs are processes of this machine's shell. */
class OutsideProgramLiveSuite extends munit.FunSuite, Waiting:
  private def started(script: String, environment: (String, String)*): OutsideProgram =
    OutsideProgram.start(Seq("sh", "-c", script), environment.toMap).fold(fail(_), identity)

  private def ended(program: OutsideProgram): OutsideProgram =
    program.await(Span.ofSeconds(60))
    program.stop()
    program

  test("a program gets its environment, and its status and last lines are known once it has ended"):
    val program = ended(started("echo one; echo $WORD; echo; echo oh >&2; exit 3", "WORD" -> "two"))
    assertEquals(program.exit, Some(3))
    assertEquals(program.lastLine, Some("two"))
    assertEquals(program.lastError, Some("oh"))

  test("only the end of a long output is kept"):
    val program = ended(started("yes | head -c 1000000; echo last"))
    assertEquals(program.lastLine, Some("last"))
    assertEquals(program.printed.length, 64 << 10)

  test("a program that reads its input gets its end immediately"):
    assertEquals(ended(started("cat; echo over")).lastLine, Some("over"))

  test("processes that the program started end with it, even reluctant ones"):
    val program                = started("(trap '' TERM; while true; do sleep 0.1; done) & echo $!; wait")
    @tailrec def child(): Long = program.lastLine match
      case Some(number) => number.toLong
      case None         => child()
    val handle = ProcessHandle.of(child())
    program.stop()
    assert(program.exit.isDefined)
    handle.ifPresent(one => one.onExit().get(): Unit)

  test("a missing program is reported in a line"):
    val told = OutsideProgram.start(Seq("no-such-program"), Map.empty).left.toOption
    assert(told.exists(_.startsWith("cannot start no-such-program: ")), told)
