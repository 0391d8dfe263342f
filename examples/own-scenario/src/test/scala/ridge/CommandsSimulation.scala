package ridge

import java.io.{ByteArrayOutputStream, PrintStream}
import java.nio.file.{Files, Path}
import scala.concurrent.duration.*
import scala.util.Using

/** Runs every command of a user's own program. */
class CommandsSimulation extends munit.FunSuite:
  override val munitTimeout: Duration = 3.minutes

  private val folder = FunFixture[Path](
    _ => Files.createTempDirectory("ridge"),
    path =>
      Using.resource(Files.walk(path))(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
  )

  /** Exit status, and both outputs combined. */
  private def run(words: String*): (Int, String) =
    val said   = ByteArrayOutputStream()
    val stream = PrintStream(said, true)
    val status = Console.withOut(stream)(Console.withErr(stream)(Main.run(words)))
    (status, said.toString)

  folder.test("the scenario is flown, and its recordings are reported, replayed and fitted"): out =>
    val flown = run(
      "fly --clock virtual --loop paused --loop stream --loop predictive --link vpn --set crest-m=25 --duration 20s --out".split(
        ' '
      ) :+
        out.toString*
    )
    assertEquals(flown._1, 0, flown._2)
    assert(clue(flown._2).contains("Results: over-the-ridge"))
    assert(flown._2.contains("off the truth by: "))
    val page = Files.readString(out.resolve("report.html"))
    assert(page.contains("From the side") && page.contains("Over-the-ridge: altitudes"))
    val recordings = Seq("stream-vpn", "predictive-vpn").map(name => out.resolve(s"$name.duckdb").toString)
    val again      = Files.createDirectory(out.resolve("again"))
    val reported   = run("report" +: recordings :+ "--out" :+ again.toString*)
    assertEquals(reported._1, 0, reported._2)
    assert(clue(reported._2).contains("Results: over-the-ridge"))
    val replayed = run("replay" +: recordings.take(1)*)
    assertEquals(replayed._1, 0, replayed._2)
    assert(clue(replayed._2).contains("all the same"))
    val fitted = run("identify" +: recordings :+ "--out" :+ again.toString*)
    assertEquals(fitted._1, 0, fitted._2)

  test("many seeds are summarised, and flights with faults keep the rules"):
    val spread = run("spread --seeds 2 --loop paused --loop stream --link vpn --duration 12s".split(' ')*)
    assertEquals(spread._1, 0, spread._2)
    assert(clue(spread._2).contains("Spread: over-the-ridge"))
    val tortured = run("torture --seeds 2 --duration 12s".split(' ')*)
    assertEquals(tortured._1, 0, tortured._2)

  folder.test("budget measures the tolerated latency"): out =>
    val swept = run(
      "budget --objective lowest-view --means 2 --jitters 2 --episodes 1 --duration 12s --out".split(
        ' '
      ) :+ out.toString*
    )
    assertEquals(swept._1, 0, swept._2)
    assert(clue(Files.readString(out.resolve("map.csv"))).linesIterator.size > 2)

  folder.test(
    "search chooses settings with SIMD in space, even if the scenario defines its own end"
  ): out =>
    val searched = run(
      ("search --objective lowest-view --vary cruise-mps=3..6 " +
        "--method random --candidates 4 --episodes 1 --fresh 2 " +
        "--duration 10s --out").split(' ') :+ out.toString*
    )
    assertEquals(searched._1, 0, searched._2)
    assert(clue(searched._2).contains("engine: SIMD, "))
    assert(clue(Files.readString(out.resolve("scenario.conf"))).contains("cruise-mps = "))

  test("unsupported requests are refused in a line with the reason"):
    val searched = run("search --objective lowest --vary cruise-mps=3..6 --candidates 4".split(' ')*)
    assertEquals(searched._1, 1)
    assert(clue(searched._2).contains("expected one of lowest-view, "))
    val (status, said) = run("fly", "--set", "crest=3", "--set", "side-m=wide")
    assertEquals(status, 1)
    assert(clue(
      said
    ).contains("--set: the scenario over-the-ridge has no setting 'crest'; expected one of crest-m"))
    assert(clue(run(
      "fly",
      "--set",
      "side-m=wide"
    )._2).contains("--set side-m: expected a number, got 'wide'"))
    assert(clue(run(
      "fly",
      "--scenario",
      "duel"
    )._2).contains("scenario: expected over-the-ridge, got 'duel'"))
    assert(clue(run(
      "fly",
      "--vehicles",
      "3"
    )._2).contains("--vehicles: the scenario over-the-ridge has no setting 'vehicles'"))

  test("the scenario's settings are listed"):
    val (status, said) = run("scenarios")
    assertEquals(status, 0)
    assert(clue(said).contains("over-the-ridge: 2 vehicles"))
    assert(said.contains("crest-m") && said.contains("Limit: separation of at least 8 m."))
