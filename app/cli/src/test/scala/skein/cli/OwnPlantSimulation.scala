package skein.cli

import java.nio.file.{Files, Path}
import skein.flight.Tilting
import skein.forecast.Structure
import skein.policy.{Axis, SearchSpace}
import skein.scenario.Scenarios
import skein.testing.{Lengthy, Optimised, TemporaryFolders}

/** A program with a structure of its own, as a user writes it. */
object Leaners extends SkeinApp(Scenarios.ours.kinds*):
  override def structures: Seq[Structure] = Seq(
    Structure(
      "leaning",
      SearchSpace(
        Vector(Axis("gain", 0.1, 2, 1), Axis("lag-s", 0.2, 10, 2), Axis("lean-lag-s", 0.02, 1, 0.1))
      ),
      values => Tilting(values(0), values(1), values(2))
    ),
    Structure("broken", SearchSpace(Vector(Axis("lag-s", 0.2, 10, 2))), _ => sys.error("no such vehicle"))
  )

class OwnPlantSimulation extends munit.FunSuite, TemporaryFolders, Lengthy, Optimised:
  private def run(program: SkeinApp, words: String): (Int, String) =
    val ran = Ran.of(program.run(words.split(' ').toSeq))
    (ran.status, ran.said)

  private def done(words: String): String =
    val (status, said) = run(Leaners, words)
    assertEquals(status, 0, said)
    said

  private def recording(folder: Path): Path =
    Files.list(folder).filter(_.toString.endsWith("vpn.duckdb")).findFirst.get

  folder.test(
    "a user's own plant is fitted to flights, simulated in searches, predicts in flight, and replays"
  ): folder =>
    val flight = "fly --clock virtual --link vpn --duration"
    done(s"$flight 40s --loop stream --out $folder/flown"): Unit
    val fitted = done(s"identify ${recording(folder.resolve("flown"))} --structure leaning --out $folder")
    assert(fitted.contains("lean-lag-s") && !fitted.contains("Off the full quadrotor"), fitted)
    // An exception of another structure ends nothing.
    assert(
      clue(fitted).linesIterator.exists(
        _.matches(
          "broken is not fitted: its plant failed: java.lang.RuntimeException: no such vehicle " +
            "\\(OwnPlantSimulation.scala:\\d+\\)"
        )
      )
    )
    val model = folder.resolve("model.conf")
    assert(Files.readString(model).contains("use = leaning"))

    val search = s"search --plant $model --candidates 4 --episodes 2 --fresh 4 --duration 12s --out $folder"
    assert(done(s"$search/shared --loop stream").contains("SIMD"))
    val foreseen = done(s"$search/foreseen --loop predictive")
    assert(clue(foreseen).contains("engine: SIMD") && !foreseen.contains("scalar"))

    done(s"$flight 8s --loop predictive --predictor $model --out $folder/foreseen"): Unit
    val flown = recording(folder.resolve("foreseen"))
    assert(done(s"replay $flown").contains("same"))

    // Skein's own program lacks the structure: both in a file, and in a recording.
    val (status, said) = run(Main, s"search --plant $model --candidates 4")
    assertEquals(status, 1)
    assert(said.contains("expected a structure (lag, turn, drag, drag-and-turn), got 'leaning'"), said)
    val (again, why) = run(Main, s"replay $flown")
    assertEquals(again, 1)
    assert(why.contains("expected a model's name or five numbers, got 'leaning "), why)
