package skein.cli

import skein.testing.Waiting

/** Programs are processes of this machine's shell. */
class ObserveProgramLiveSuite extends munit.FunSuite, Waiting:
  private def run(program: String*): Ran = Ran.of(ObserveCommand.run(
    Seq("--json", "--listen", "127.0.0.1:0", "--simulator", "127.0.0.1:1", "--") ++ program
  ))

  test("with --json a program's output goes to standard error, so that standard output contains only JSON"):
    val ran = run("sh", "-c", "echo hello; exit 3")
    assertEquals(ran.status, 0, ran.said)
    assert(ran.err.linesIterator.contains("hello"), ran.said)
    assert(ran.err.contains("sh ended with exit status 3"), ran.said)
    assert(ujson.read(ran.out).objOpt.isDefined || ujson.read(ran.out).arrOpt.isDefined, ran.out)

  test("a missing program is reported in a line"):
    val ran = run("no-such-program")
    assertEquals(ran.status, 1)
    assert(ran.err.contains("cannot start no-such-program: "), ran.said)
