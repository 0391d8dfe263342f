package skein.cli

import java.nio.file.{Files, Path}
import skein.loop.{LoopEvent, OwnLoop, SnapshotGraph}
import skein.scenario.Scenarios
import skein.testing.{TemporaryFolders, Unhurried}

/** A program with a user's own loop, in which the vehicles take turns to decide. */
object TakingTurns extends SkeinApp(Scenarios.ours.kinds*):
  override def loops: Seq[OwnLoop] = Seq(
    OwnLoop(
      "turns",
      (team, stop) =>
        val snapshots = team
          .ticks(team.now)
          .mapAsync(1)(_ => team.readAll())
          .collect { case Right(readings) => readings }
          .zipWithIndex
          .map((readings, turn) => LoopEvent.Seen(readings, Set((turn % team.vehicles.size).toInt)))
        SnapshotGraph(team, snapshots.via(stop.flow), stop)
    )
  )

class ListedLoopSimulation extends munit.FunSuite, Unhurried, TemporaryFolders:
  private def run(program: SkeinApp, words: String) = Ran.of(program.run(words.split(' ').toSeq))

  private def fly(out: Path) = run(
    TakingTurns,
    s"fly --clock virtual --loop paused --loop turns --link vpn --duration 12s --out $out"
  )

  folder.test("a program's own loop is run by its name, reported with its graph, and replayed"): folder =>
    val flown = fly(folder)
    assertEquals(flown.status, 0, flown.said)
    assert(flown.out.linesIterator.exists(_.matches("turns +vpn +11.[89] .*%.*")), flown.said)
    assert(Files.exists(folder.resolve("figures/graph-turns.svg")))
    val recording = folder.resolve("turns-vpn.duckdb")
    val replayed  = run(TakingTurns, s"replay $recording")
    assertEquals(replayed.status, 0, replayed.said)
    assert(replayed.said.contains("flown again"), replayed.said)

    // A program without the loop can repeat its decisions, but not its flights.
    val elsewhere = run(Main, s"replay $recording")
    assertEquals(elsewhere.status, 0, elsewhere.said)
    assert(!elsewhere.said.contains("flown again"), elsewhere.said)

  folder.test("an own loop can be spread and completed, and a program without it lists its loops"): folder =>
    val spread =
      run(TakingTurns, s"spread --loop turns --link vpn --seeds 2 --duration 12s --out $folder/spread")
    assertEquals(spread.status, 0, spread.said)
    for name <- Seq("fly", "spread") do
      val loop = TakingTurns.commands.find(_.name == name).get.options.find(_.flag == "--loop").get
      assert(clue(loop.values).contains("turns"))
    val unknown = run(Main, "fly --loop turns")
    assertEquals(unknown.status, 1)
    assert(
      unknown.said.contains("expected one of paused, sequential, futures, stream, predictive, plan"),
      unknown.said
    )

  test("two loops with one name are refused"):
    val known = TakingTurns.scenarios
    intercept[IllegalArgumentException](known.copy(loops = known.loops ++ known.loops))
