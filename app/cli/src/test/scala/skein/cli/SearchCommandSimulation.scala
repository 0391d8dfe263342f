package skein.cli

import skein.gpu.CudaGpu
import skein.optimise.RunningStats
import skein.search.SearchFile
import skein.testing.{Optimised, TemporaryFolders}

class SearchCommandSimulation extends munit.FunSuite, TemporaryFolders, Optimised:
  test("with --json a search prints its result as data, and everything else to the error output"):
    val words =
      "search --family lead-pursuit --candidates 8 --episodes 1 --fresh 2 --duration 12s --json --out".split(
        ' '
      ).toSeq
    val ran = Ran.of(Main.run(words :+ temporaryFolder().resolve("found").toString))
    assertEquals(ran.status, 0, ran.err)
    val table = ujson.read(ran.out)("tables")(0)
    assertEquals(table("columns")(0).str, "policy")
    val Seq(found, paper) = table("rows").arr.toSeq: @unchecked
    assertEquals((found(0).str, paper(0).str), ("lead-pursuit", "paper-pursuer"))
    assertEquals((found(4).num, paper(4).num), (2.0, 2.0))
    assert(found(2).num > 0 && found(3).num > 0, found.toString)
    assert(found(6).str.startsWith("SIMD, ") && paper(6).str.startsWith("SIMD, "), found.toString)
    assert(ran.err.contains("policy.conf"))

  test("--gpu is refused with other processes, and without a GPU, before any output is written"):
    val folder                                 = temporaryFolder().resolve("found")
    def refused(words: String*): (Int, String) =
      val ran = Ran.of(Main.run(Seq("search", "--gpu", "--out", folder.toString) ++ words))
      assert(!java.nio.file.Files.exists(folder))
      (ran.status, ran.err.linesIterator.mkString)
    val (status, told) = refused("--workers", "2")
    assert(status != 0 && told.contains("--gpu: expected without --workers and --cluster"), told)
    for why <- CudaGpu.find().left do
      val (status, told) = refused()
      assert(status != 0 && told.contains(s"--gpu: $why"), told)

  test("a search whose defaults another program scored otherwise is not continued"):
    val folder             = temporaryFolder().resolve("found")
    def ran(words: String) = Ran.of(Main.run(s"search $words $folder".split(' ').toSeq))
    assertEquals(ran("--candidates 4 --episodes 1 --population 4 --fresh 2 --duration 12s --out").status, 0)
    val file                  = SearchFile.read(folder).fold(fail(_), identity)
    def again(of: SearchFile) =
      assertEquals(SearchFile.write(folder, of), Right(()))
      ran("--resume")
    val other = again(file.copy(probe = file.probe.map(_ => RunningStats.of(4)(_ + 0.5))))
    assertEquals(other.status, 1)
    assert(
      clue(other.err).contains("they scored 2.0 when the search began: expected the program of that time")
    )
    for same <- Seq(file, file.copy(probe = Vector.empty)) do assertEquals(again(same).status, 0)

  test("a population is refused with methods that have no generations"):
    val ran = Ran.of(Main.run("search --method grid --population 20".split(' ').toSeq))
    assertEquals(ran.status, 1)
    assert(clue(ran.err).contains("--population: expected with cma-es or cross-entropy, got grid"))

  test("without an objective, the scenario's measures are listed"):
    val ran = Ran.of(Main.run(Seq("search", "--scenario", "crossing", "--vary", "lane-m=4..8")))
    assertEquals(ran.status, 1)
    assertEquals(
      ran.err.linesIterator.toVector,
      Vector("skein search: --objective: expected a sum of the measures of crossing: closest, at, " +
        "violations, arrived, to-goal, per-min")
    )
