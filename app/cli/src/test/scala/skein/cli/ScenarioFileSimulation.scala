package skein.cli

import java.nio.file.Files
import scala.jdk.CollectionConverters.*
import skein.docs.Documentation
import skein.testing.{TemporaryFolders, Unhurried}

/** Commands accept a scenario's file like a scenario of the program, and a recording contains its text. */
class ScenarioFileSimulation extends munit.FunSuite, TemporaryFolders, Unhurried:
  private val ring = Documentation.root.resolve("examples/scenario-in-python/ring.scenario")

  private def ran(words: String*): Ran = Ran.of(Main.run(words))

  private def well(words: String*): String =
    val done = ran(words*)
    assertEquals(done.status, 0, s"${words.mkString(" ")}: ${done.said}")
    done.said

  folder.test("flights of a scenario's file are reported and replayed from the recording only"): path =>
    val file = Files.copy(ring, path.resolve("ring.scenario"))
    val told = well(
      ("fly --clock virtual --loop predictive --link vpn --duration 6s --set ring-m=6 --scenario " +
        s"$file --out $path/flights").split(' ')*
    )
    assert(told.contains("off ring"), told)
    Files.delete(file)
    val recording =
      Files.list(path.resolve("flights")).iterator.asScala.map(_.toString).filter(_.endsWith(".duckdb")).toSeq
    assertEquals(recording.size, 1)
    val replayed = well("replay" +: recording*)
    assertEquals("all the same".r.findAllIn(replayed).size, 2, replayed)
    val reported = well(Seq("report", "--out", s"$path/report") ++ recording*)
    assert(reported.contains("off ring"), reported)
    val pictures =
      Files.list(path.resolve("report/figures")).iterator.asScala.map(_.getFileName.toString).toSet
    assert(Set("ring-trajectories.svg", "ring-measure.svg").subsetOf(pictures), pictures)
    val other = Files.copy(ring, path.resolve("again.scenario"))
    val again = well(
      s"fly --clock virtual --loop predictive --link vpn --duration 6s --set ring-m=6 --scenario=$other --out $path/again".split(
        ' '
      )*
    )
    def digest(said: String) = "SHA-256 of its recording: (\\w+)".r.findFirstMatchIn(said).map(_.group(1))
    assertEquals(digest(again), digest(told))
    assert(digest(told).isDefined, told)

  folder.test("a configuration can name a scenario's file, and a search writes one with its text"): path =>
    val config = Files.writeString(
      path.resolve("ring.conf"),
      s"""skein.fly { scenario = "$ring", ring { ring-m = 7 }, duration = 4s }"""
    )
    well(s"fly --clock virtual --loop stream --link vpn --config $config --out $path/flights".split(' ')*)
    well(
      (s"search --scenario $ring --vary ring-m=4..12 --objective off-ring --candidates 12 --episodes 2 --fresh 4 " +
        s"--duration 12s --link vpn --out $path/search").split(' ')*
    )
    val found = Files.readString(path.resolve("search/scenario.conf"))
    assert(found.contains("ring-m = "), found)
    well(
      (s"fly --clock virtual --loop stream --link vpn --duration 4s --config $path/search/scenario.conf " +
        s"--out $path/found").split(' ')*
    )

  folder.test("budget, torture and scenarios accept a scenario's file"): path =>
    well(
      (s"budget --scenario $ring --objective off-ring --duration 12s --episodes 16 --means 2 --jitters 2 " +
        s"--out $path/budget").split(' ')*
    )
    well(s"torture --scenario $ring --seeds 1 --duration 7s".split(' ')*)
    val listed = well("scenarios", ring.toString)
    assert(listed.contains("ring: 6 vehicles, 60 s") && listed.contains("radius of the ring, m"), listed)

  folder.test("a mistake in a scenario's file is reported in one line, with its position"): path =>
    val wrong = Files.writeString(path.resolve("wrong.scenario"), "skein-scenario 1\nname wrong\n0 add 1 2\n")
    for words <- Seq("fly", "spread", "search", "budget", "torture", "learn") do
      val told = ran(words, "--scenario", wrong.toString)
      assertEquals(told.status, 1, told.said)
      assertEquals(
        told.said.trim,
        s"skein $words: --scenario: $wrong: line 3: expected a number's node of an earlier line, of which there is none, got '1'"
      )
    val absent = ran("fly", "--scenario", s"$path/no.scenario")
    assert(absent.err.startsWith(s"skein fly: --scenario: there is no file $path/no.scenario"), absent.err)
    val unknown = ran("fly", "--clock", "virtual", "--scenario", ring.toString, "--set", "rings=3")
    assert(
      unknown.err.contains("the scenario ring has no setting 'rings'; expected one of ring-m, "),
      unknown.err
    )
