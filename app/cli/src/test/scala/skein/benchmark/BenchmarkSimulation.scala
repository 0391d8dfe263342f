package skein.benchmark

import java.nio.file.Files
import skein.plot.Svg
import skein.policy.{PolicyFamily, Role}
import skein.report.Section
import skein.scenario.{Convoy, ScenarioKind, Scenarios, Shadow}
import skein.settings.PolicyFile
import skein.testing.{TemporaryFolders, Unhurried}

class BenchmarkSimulation extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given Scenarios = Scenarios.ours

  private val few = BenchmarkSet(
    Vector(BenchmarkSet.Named("duel", "scenario = duel, duration = 14s")),
    Vector("vpn"),
    Vector(
      BenchmarkSet.Named("as modelled", "airsim"),
      BenchmarkSet.Named("wind", "airsim:wind=8/0/0")
    ),
    Vector(
      BenchmarkSet.Entry("stream", "stream"),
      BenchmarkSet.Entry("model", "predictive"),
      BenchmarkSet.Entry("adaptive", "predictive", "adaptive")
    )
  )

  test("each entry is simulated in each cell once per seed, and compared with the cell's paused loop"):
    val benchmark = Benchmark(few, seeds = 2)
    var landed    = 0
    val rows      = benchmark.fly(more => landed += more).fold(fail(_), identity)
    assertEquals(landed, benchmark.flights)
    assertEquals(
      rows.map(row => (row.cell.world.name, row.entry.name)),
      few.cells.flatMap(cell =>
        few.entries.map(entry => (cell.world.name, entry.name))
      )
    )
    assertEquals(rows.map(_.flights.size).distinct, Vector(2))
    val Vector(calm, windy) = rows.map(_.truth).distinct: @unchecked
    assertNotEquals(calm, windy)
    def row(world: String, entry: String) =
      rows.find(r => r.cell.world.name == world && r.entry.name == entry).get
    for world <- few.worlds.map(_.name) do
      assert(row(world, "model").meanOff.get.abs < row(world, "stream").meanOff.get.abs, world)
      assertEquals(row(world, "stream").errorP95M, None)
    assert(row("wind", "adaptive").errorP95M.get < row("wind", "model").errorP95M.get / 2)
    val again = Benchmark(few, seeds = 2).fly().fold(fail(_), identity)
    assertEquals(Section.json(BenchmarkTables.of(again)), Section.json(BenchmarkTables.of(rows)))

  test("every cell of the published set has settings"):
    for cell <- BenchmarkSet.Published.cells; entry <- BenchmarkSet.Published.entries do
      assertEquals(cell.settings(entry, 1).map(_.plans.size), Right(1))

  test("without options, a program has the tasks of its scenarios, else its scenarios as tasks"):
    val some  = Scenarios(ScenarioKind(Shadow()), ScenarioKind(Convoy()))
    val tasks = BenchmarkSet.Published.tasksOf
    assertEquals(tasks(Scenarios.ours), BenchmarkSet.Published.tasks)
    assertEquals(tasks(some).map(_.name), Vector("shadow", "hidden-shadow"))
    assertEquals(tasks(Scenarios(ScenarioKind(Convoy()))).map(_.name), Vector("convoy"))

  test("a user's policy is compared with the scenario's only in tasks with its role"):
    val file = Files.writeString(
      temporaryFolder().resolve("mine.policy"),
      PolicyFile
        .ofDefaults(Role.Pursuer, PolicyFamily.leadPursuit).hocon("")
    )
    val set = few
      .copy(
        tasks = few.tasks :+ BenchmarkSet.Named("formation", "scenario = formation, duration = 14s"),
        worlds = few.worlds.take(1),
        entries = few.entries.take(1)
      )
      .flownBy(Seq(file.toString))
    val benchmark = Benchmark(set, seeds = 2)
    assertEquals(benchmark.mistake, None)
    assertEquals(
      benchmark.notFlown.map(_.takeWhile(_ != ':')),
      Vector("stream, mine.policy does not fly formation")
    )
    val rows = benchmark.fly().fold(fail(_), identity)
    assertEquals(
      rows.map(row => (row.cell.task.name, row.entry.name)),
      Vector("duel" -> "stream", "duel" -> "stream, mine.policy", "formation" -> "stream")
    )
    assertEquals(rows(0).truth, rows(1).truth)
    assertNotEquals(rows(0).meanOff, rows(1).meanOff)
    assert(Svg.file(BenchmarkFigure(rows), "benchmark").contains("stream, mine.policy"))
    val packets = few.copy(entries = Vector(BenchmarkSet.Entry("packets", "stream", isInPacket = true)))
    val partly  =
      Benchmark(
        set.copy(entries = set.entries ++ packets.flownBy(Seq(file.toString)).entries.drop(1)),
        seeds = 2
      )
    assertEquals(partly.mistake, None, "the policy flies by another loop")
    assert(
      clue(partly.notFlown).exists(_.startsWith("packets, mine.policy does not fly duel: expected with the"))
    )
    val nowhere = set.copy(tasks = set.tasks.drop(1))
    assert(clue(Benchmark(
      nowhere,
      seeds = 2
    ).mistake).exists(_.contains("expected with a scenario of a pursuer")))

  test("entries of policies whose files have one name differ in name"):
    val set = few.copy(entries = few.entries.take(1)).flownBy(Seq("a/policy.conf", "b/policy.conf", "own"))
    assertEquals(
      set.entries.map(_.name),
      Vector("stream", "stream, policy.conf", "stream, policy.conf-2", "stream, own")
    )

  test("the interval is that of the mean over seeds, and a mean of 0 in the paused loop gives no deviation"):
    def flights(values: Double*) =
      values.toVector.map(value => BenchmarkFlight(Some(value), violations = 2, None, Vector.empty))
    val cell = few.cells.head
    val row  = BenchmarkRow(cell, few.entries.head, flights(10, 10), flights(11, 13), Vector.empty)
    assertEqualsDouble(row.meanOff.get, 0.2, 1e-12)
    assertEqualsDouble(row.halfOff.get, 12.706 * 0.1, 1e-12)
    assertEqualsDouble(row.violations, 0, 0)
    assertEquals(BenchmarkRow(cell, few.entries.head, flights(0), flights(1), Vector.empty).meanOff, None)

  test(
    "the interval contains the error of the paused loop's mean; a rise of a negative measure is positive"
  ):
    def flights(values: Double*) =
      values.toVector.map(value => BenchmarkFlight(Some(value), violations = 0, None, Vector.empty))
    def row(truths: Vector[BenchmarkFlight], flown: Vector[BenchmarkFlight]) =
      BenchmarkRow(few.cells.head, few.entries.head, truths, flown, Vector.empty)
    val wide = row(flights(9, 11), flights(20, 20))
    assertEqualsDouble(wide.meanOff.get, 1, 1e-12)
    assertEqualsDouble(wide.halfOff.get, 2 * 12.706 * 0.1, 1e-3)
    assertEqualsDouble(row(flights(-10), flights(-8)).meanOff.get, 0.2, 1e-12)
    assertEquals(row(flights(9), flights(20, 20)).halfOff, None)
