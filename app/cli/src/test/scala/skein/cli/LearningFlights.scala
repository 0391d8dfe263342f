package skein.cli

import java.nio.file.{Files, Path}
import skein.record.{EventKind, RecordingReader}
import skein.report.PaperReport
import skein.scenario.Scenarios

/** A flight with a learned policy, with and without learning in flight, in turns: `cli/Test/runMain
  * skein.cli.learningFlights 60 3`. Network and lessons have their default sizes.
  */
@main def learningFlights(seconds: Int, rounds: Int): Unit =
  given Scenarios = PaperReport.scenarios
  val folder      = Files.createTempDirectory("learning")
  val learned     = folder.resolve("learned")
  val teaching    = "--steps 20000 --lesson 10s --episodes 2 --fresh 4 --flights 1 --duration 12s".split(' ')
  require(
    LearnCommand("skein").run(teaching.toSeq ++ Seq("--out", learned.toString)) == 0,
    "nothing was learned"
  )
  val policy = learned.resolve("policy.conf").toString
  for
    round           <- 1 to rounds
    (what, options) <-
      Seq("flies" -> Seq("--policy", policy), "learns on" -> Seq("--learn", learned.toString))
  do
    val out    = folder.resolve(s"$round-${options.head}")
    val fixed  = Seq("--loop", "stream", "--link", "none", "--duration", s"${seconds}s")
    val flying = ViewLiveSuite.Flying.start(out, fixed ++ options*)
    flying.land()
    val file = flownIn(out)
    val late = Lateness.of(file)
    val told = RecordingReader.read(file).fold(error => sys.error(error.message), _.events)
    val news = told.count(_.kind == EventKind.Learned)
    println(
      f"$what%-9s ${late.questions}%,d questions, late p50 ${late.p50Ms}%.2f, p99 ${late.p99Ms}%.2f, most " +
        f"${late.mostMs}%.2f ms; $news versions, ${told.size - news} other events; load ${load()}"
    )

private def flownIn(out: Path): Path =
  import scala.jdk.CollectionConverters.*
  scala.util.Using.resource(Files.list(out))(_.iterator.asScala.find(_.toString.endsWith(".duckdb")).get)
