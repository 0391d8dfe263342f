package skein.cli

import java.nio.file.{Files, Path}
import skein.docs.Documentation
import skein.report.PaperReport
import skein.scenario.Scenarios
import skein.testing.{Conclusive, Lengthy, PythonEnvironment, TemporaryFolders, Waiting}

/** A script with AirSim's own Python client, run in real time, and the simulation of its policies in the loop
  * that it copies.
  */
class MarginOfScriptLiveSuite extends munit.FunSuite, Conclusive, TemporaryFolders, Lengthy, Waiting:
  private given Scenarios = PaperReport.scenarios

  private val client = PythonEnvironment.ofAirSim()

  private val Ms = Seq(0.0, 80.0)

  /** The example's mean distance in the last 10 s, m, without a link and over 80 ms. */
  private def flown(out: Path): Seq[Double] =
    val old     = Documentation.root.resolve("vehicles/simulator/src/test/resources/airsim-python")
    val script  = Documentation.root.resolve("examples/delay-margin/pursuit.py")
    val program = Seq("env", s"PYTHONPATH=$old", client.python().toString, script.toString, "{port}")
    val options = Seq("--scenario", "duel", "--link", "constant:80ms", "--repeats", "2", "--seconds", "30")
    val ran     = Ran.of(MarginCommand().run(options ++ Seq("--out", s"$out", "--") ++ program))
    assertEquals(ran.status, 0, ran.said)
    val rows = ujson.read(Files.readString(out.resolve("margin.json")))("tables")(0)("rows").arr
    println(ran.out)
    rows.map(row => row(4).str.takeWhile(_ != ' ').toDouble).toSeq

  private def simulated(out: Path): Seq[Double] =
    val loop = Seq("--loop", "sequential", "--plant", "quadrotor", "--duration", "30s", "--episodes", "20")
    val axes = Seq("--means", "2", "--most-mean", "160ms", "--jitters", "2", "--most-jitter", "1ms")
    val ran  = Ran.of(
      BudgetCommand("skein.cli.Main").run(loop ++ axes ++ Seq("--at-jitter", "0ms", "--out", s"$out"))
    )
    assertEquals(ran.status, 0, ran.said)
    val cells = ujson.read(Files.readString(out.resolve("map.json")))(0)("cells").arr
    Ms.map: ms =>
      val cell = cells.find(cell => cell("meanMs").num == ms && cell("jitterMs").num == 0)
      cell.getOrElse(fail(s"$cells"))("objective").num

  test("a script's copy of the paper's pursuit flies as the simulated loop does, with and without a link"):
    client.python(): Unit
    conclusive:
      val (one, other) = (flown(temporaryFolder()), simulated(temporaryFolder()))
      for ((ms, script), loop) <- Ms.zip(one).zip(other) do
        assert(
          math.abs(script - loop) < 0.1 * loop,
          s"over $ms ms the script has $script m, the loop $loop m"
        )
