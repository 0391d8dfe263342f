package skein.cli

import java.nio.file.{Files, Path}
import skein.report.DuelReport
import skein.scenario.Scenarios
import skein.testing.{Lengthy, TemporaryFolders, Waiting}

/** Programs are processes of this machine's shell. Runs in a separate JVM, since the command gives its
  * threads precedence.
  */
class MarginCommandLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy, Waiting:
  private given Scenarios = DuelReport.scenarios

  private def run(folder: Path, words: String*): Ran =
    Ran.of(MarginCommand().run(Seq("--out", s"$folder") ++ words))

  private val once = Seq("--link", "constant:20ms", "--repeats", "1")

  folder.test("a program that connects and prints a number is judged by that number, over each link"): out =>
    val program = "exec 3<>/dev/tcp/127.0.0.1/$SKEIN_PORT; echo hello; echo $(({port} - SKEIN_PORT + 7))"
    val ran     = run(out, once ++ Seq("--judge", "printed", "--", "bash", "-c", program)*)
    // A busy machine may spoil a run, which is reported.
    assume(!ran.said.contains("too busy"), "inconclusive")
    assertEquals(ran.status, 0, ran.said)
    assert(ran.err.contains("constant:20ms, run 1 of 1: the printed number 7"), ran.said)
    assert(ran.out.contains("The printed number stays within 5 % of what it is without a link, 7,"), ran.out)
    assert(Files.readString(out.resolve("programs.txt")).contains("== none, run 1\nhello\n7"))
    assert(Files.size(out.resolve("margin.png")) > 1000)

  folder.test("a program that fails without a link ends the command in a line, before other links"): out =>
    val script = "echo 'no module airsim' >&2; exit 1"
    val ran    = run(out, once ++ Seq("--scenario", "duel", "--", "bash", "-c", script)*)
    assertEquals(ran.status, 1)
    val line = ran.err.linesIterator.toSeq.last
    assert(line.startsWith("skein margin: without a link: it ended with exit status 1 after "), ran.err)
    assert(line.endsWith(": no module airsim"), ran.err)
