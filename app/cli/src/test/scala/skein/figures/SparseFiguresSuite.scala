package skein.figures

import skein.measure.Distribution
import skein.plot.{Drawing, Mark, Panel, PlotAxis, Theme}
import skein.report.{PaperReport, Report, SyntheticFlight}
import skein.scenario.Scenarios
import skein.training.{LearnScore, LearningCurve}

/** Figures of very few data, and of data that are far apart. */
class SparseFiguresSuite extends munit.FunSuite:
  private given Scenarios = PaperReport.scenarios

  private def texts(drawing: Drawing): Vector[String] =
    drawing.shapes.toVector.collect { case text: Mark.Text => text.content }

  private def headings(seconds: Int): Vector[String] =
    val flights = Report.of(Seq(SyntheticFlight("stream", "vpn", seed = 2, seconds)))
    texts(DistanceFigure(flights).get).filter(_.startsWith("last 10 s"))

  test("the legend lists the last 10 s if they are drawn, and the paper's values if there are any"):
    assertEquals(headings(8), Vector.empty)
    assertEquals(headings(12), Vector("last 10 s: ours ●"))
    assertEquals(headings(60), Vector("last 10 s: ours ●, paper ◆"))

  test("the paper's greatest distance does not compress our curves, and each column has its flight's name"):
    val flights = Report.of(Seq(SyntheticFlight("sequential", "vpn", seed = 2, 60)))
    val figure  = DistanceFigure(flights).get
    val ours    = flights.flights.flatMap(_.distance).flatMap(_.points.map(_._2)).max
    assert(flights.flights.flatMap(_.published).flatMap(_.distance).map(_.most).max > 1.3 * ours, ours)
    val heights =
      figure.shapes.collect { case Mark.Path(points, _, None, _) if points.size > 20 => points.map(_.y) }
    // The panel is 220 units high, from 34 on.
    assert(heights.flatten.min < 34 + 0.3 * 220, heights.flatten.min)
    assert(texts(figure).contains("mean 41 m") || texts(figure).contains("mean 40 m"), texts(figure))
    val upright = figure.shapes.collect { case text: Mark.Text if text.upwards => text.content }
    assertEquals(upright.filterNot(_.startsWith("mean ")).toSet, Set("distance, m", "sequential"))

  test("the observations of few loops fill the figure's width: the legend takes rows"):
    val figure = ObservationFigure(Report.of(Seq("sequential", "stream").map(
      SyntheticFlight(_, "vpn", seed = 2, 60)
    ))).get
    val lines = figure.shapes.collect { case path: Mark.Path => path.points.map(_.x).max }
    assert(clue(lines.max) > 0.85 * clue(figure.width))
    val cut = figure.shapes.collect:
      case text: Mark.Text
          if text.bold && text.at.x + text.content.length * Theme.titleLetter > figure.width =>
        text.content
    assertEquals(cut.toVector, Vector.empty)

  test("the labels of neighbouring columns' arrows do not overlap"):
    val loops   = Seq("sequential", "futures", "stream")
    val flights = Report.of(loops.map(SyntheticFlight(_, "vpn", seed = 2, 60)))
    val arrows  = DistanceFigure(flights).get.shapes.collect:
      case text: Mark.Text if text.content.startsWith("mean ") || text.content.startsWith("to ") => text
    assert(arrows.size > 1 && arrows.forall(_.upwards), arrows)
    val columns = arrows.map(_.at.x).sorted
    assert(columns.zip(columns.tail).forall((one, next) => next - one > arrows.head.size), columns)

  test("a legend lists only drawn items: for a link without a profile, the measured round trips"):
    val trips                = Distribution.of(Vector.tabulate(100)(index => 130 + index * 0.1)).get
    def legend(link: String) =
      texts(LatencyFigure(Seq(LatencyFigure.Measured("to 10.0.0.7:41451", link, trips))).get)
        .filter(Set(
          "measured",
          "the link's profile",
          "its quantiles",
          "half of a sample each way, as emulated"
        ))
    assertEquals(legend("none"), Vector("measured"))
    assertEquals(legend("direct").size, 4)
    val real = LatencyFigure(Seq(LatencyFigure.Measured("to 10.0.0.7:41451", "none", trips))).get
    assert(texts(real).contains("to 10.0.0.7:41451") && !texts(real).exists(_.contains("no link added")))
    assertEquals(real.width, 378.0)

  test("a title is at most as wide as its panel"):
    val panel              = Panel(PlotAxis.around("x", 0, 1), PlotAxis.around("y", 0, 1), 52, 34, 230, 200)
    def size(text: String) = Vector(panel.fittedTitle(text)).collect { case text: Mark.Text =>
      text.size
    }.head
    assertEquals(size("stream, vpn link"), Theme.titleSize)
    val long = "stream, learned:2tanh:clip, vpn link"
    assert(clue(size(long)) * Theme.titleLetter / Theme.titleSize * long.length <= 230 + 1e-9)

  test("a single score of a learner is visible"):
    val colour           = LearningCurve.learned
    def discs(many: Int) =
      val scores = Vector.tabulate(many)(index => LearnScore(1000L * (index + 1), 5, 1))
      LearningCurve("ppo", "m", Seq(("ppo", colour, scores)), Nil).shapes
        .collect { case disc: Mark.Disc => disc.fill }
        .toVector
    assertEquals(discs(1), Vector(Some(colour)))
    assertEquals(discs(2), Vector.empty)

  test("a round trip far longer than all others is counted, and does not compress the axis"):
    val usual  = Vector.tabulate(1000)(index => 30 + index * 0.02)
    val shapes =
      LatencyFigure(
        Seq(LatencyFigure.Measured("direct", "direct", Distribution.of(usual ++ Vector.fill(9)(900.0)).get))
      ).get.shapes.toVector
    val bars = shapes.collect:
      case Mark.Path(points, None, Some(_), _) => points.map(_.x).max - points.map(_.x).min
    assert(bars.sum > 40, s"the bars are ${bars.sum} wide together")
    assert(shapes.exists {
      case Mark.Text(_, content, _, _, _, _, _) => content.endsWith("max 900 ms"); case _ => false
    })
