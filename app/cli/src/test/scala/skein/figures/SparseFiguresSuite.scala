package skein.figures

import skein.measure.Distribution
import skein.plot.{Drawing, Mark}
import skein.report.{DuelReport, Report, SyntheticFlight}
import skein.scenario.Scenarios
import skein.training.{LearnScore, LearningCurve}

/** Figures of very little, and of what lies far apart. */
class SparseFiguresSuite extends munit.FunSuite:
  private given Scenarios = DuelReport.scenarios

  private def texts(drawing: Drawing): Vector[String] =
    drawing.shapes.toVector.collect { case text: Mark.Text => text.content }

  private def headings(seconds: Int): Vector[String] =
    val flights = Report.of(Seq(SyntheticFlight("stream", "vpn", seed = 2, seconds)))
    texts(DistanceFigure(flights).get).filter(_.startsWith("last 10 s"))

  test("the last 10 s are announced where they are drawn, and the paper's where there is any"):
    assertEquals(headings(8), Vector.empty)
    assertEquals(headings(12), Vector("last 10 s: ours ●"))
    assertEquals(headings(60), Vector("last 10 s: ours ●, paper ◆"))

  test("a single score of a learner is seen"):
    val colour           = LearningCurve.learned
    def discs(many: Int) =
      val scores = Vector.tabulate(many)(index => LearnScore(1000L * (index + 1), 5, 1))
      LearningCurve("ppo", "m", Seq(("ppo", colour, scores)), Nil).shapes
        .collect { case disc: Mark.Disc => disc.fill }
        .toVector
    assertEquals(discs(1), Vector(Some(colour)))
    assertEquals(discs(2), Vector.empty)

  test("a round trip far longer than all others is told, and does not squeeze them"):
    val usual  = Vector.tabulate(1000)(index => 30 + index * 0.02)
    val shapes =
      LatencyFigure(Seq("direct" -> Distribution.of(usual ++ Vector.fill(9)(900.0)).get)).get.shapes.toVector
    val bars = shapes.collect:
      case Mark.Path(points, None, Some(_), _) => points.map(_.x).max - points.map(_.x).min
    assert(bars.sum > 40, s"the bars are ${bars.sum} wide together")
    assert(shapes.exists {
      case Mark.Text(_, content, _, _, _, _, _) => content.endsWith("max 900 ms"); case _ => false
    })
