package skein.search

import skein.optimise.{Direction, Evaluator, RunningStats}
import skein.plot.{ColourScale, Mark}
import skein.policy.{Axis, SearchSpace}
import skein.testing.Optimised

class LandscapeSuite extends munit.FunSuite, Optimised:
  private val space =
    SearchSpace(Vector(
      Axis("flat", 0, 1),
      Axis("steep", -1, 1),
      Axis("slight", -1, 1),
      Axis("sloping", 0, 4)
    ))

  private val evaluator: Evaluator = (candidates, episodes) =>
    candidates.map: c =>
      RunningStats.of(episodes.size)(_ => 10 * c(1) * c(1) + 0.01 * c(2) + c(3))

  test("the two most sensitive of many parameters are drawn, with the others at their best values"):
    val best = Vector(0.5, 0.0, 1.0, 2.0)
    val land = Landscape.of(space, best, evaluator, 0 until 3, () => false, onMap = 5).get
    assertEquals(Landscape.of(space, best, evaluator, 0 until 3, () => true), None)
    assertEquals((land.x, land.y), (1, Some(3)))
    assertEquals(land.cells.map(_.size), Vector.fill(5)(5))
    assertEqualsDouble(land.cells(4)(0).mean, 10 + 0.01 + 4, 1e-12)
    assertEquals(land.csv.linesIterator.next(), "steep,sloping,mean,sd,episodes")
    assertEquals(land.csv.linesIterator.size, 26)

  test("one parameter gives a curve"):
    val line                = SearchSpace(Vector(Axis("x", -1, 1)))
    val parabola: Evaluator =
      (candidates, episodes) => candidates.map(c => RunningStats.of(episodes.size)(_ => c(0) * c(0)))
    val land = Landscape.of(line, Vector(0.0), parabola, 0 until 2, () => false).get
    assertEquals(land.y, None)
    assertEqualsDouble(land.cells.head.map(_.mean).min, 0, 1e-12)
    val drawing = LandscapeFigure(land, "title", "value", Direction.Minimise)
    val texts   = drawing.shapes.collect { case text: Mark.Text => text.content }
    assert(texts.contains("title") && texts.contains("x") && texts.contains("value"), texts)

  test("NaN values of a curve are not drawn"):
    val line                         = SearchSpace(Vector(Axis("x", 0, 1)))
    def drawn(ofX: Double => Double) =
      val values: Evaluator =
        (candidates, episodes) => candidates.map(c => RunningStats.of(episodes.size)(_ => ofX(c(0))))
      val land = Landscape.of(line, Vector(0.0), values, 0 until 2, () => false).get
      LandscapeFigure(land, "title", "value", Direction.Minimise)
    for wrong <- Seq(Double.PositiveInfinity, Double.NaN) do
      val some   = drawn(x => if x > 0.5 then wrong else x)
      val places = some.shapes.collect { case Mark.Path(points, _, _, _) => points }.flatten
      assert(places.forall(at => at.x >= 0 && at.x <= some.width && at.y >= 0 && at.y <= some.height))
      assert(drawn(_ => wrong).shapes.nonEmpty)

  private def at(dimension: Int) =
    val names = Vector("turnRateRadPerS", "lead", "captureRadiusM", "gain", "speedRatio", "w")
    val space = SearchSpace(names.take(dimension).map(Axis(_, 0, 2)))
    val best  = Vector(0.5, 1.23456, 1.5, 1.75, 0.25, 0.125).take(dimension)
    Landscape(space, best, 0, Some(1), Vector(0, 2), Vector(0, 2), Vector.fill(2, 2)(RunningStats(3, 1, 0)))

  test("parameters that are not drawn are listed with their values, or counted if there are many"):
    assertEquals(LandscapeFigure.fixed(at(2)), None)
    assertEquals(LandscapeFigure.fixed(at(3)), Some("at the best: capture radius = 1.5 m"))
    assertEquals(LandscapeFigure.fixed(at(4)), Some("at the best: capture radius = 1.5 m, gain = 1.75"))
    assertEquals(LandscapeFigure.fixed(at(6)), Some("4 others at the best"))
    val shapes = LandscapeFigure(at(3), "title", "last10s, m", Direction.Minimise).shapes
    val texts  = shapes.collect { case text: Mark.Text => text.content }
    // The marks, and equal marks in the legend: the found one as a ring, which does not hide the default.
    val (rings, discs) = shapes.collect { case disc: Mark.Disc => disc }.partition(_.fill.isEmpty)
    assertEquals((rings.groupBy(_.centre).size, discs.groupBy(_.centre).size), (2, 2))
    assert(rings.map(_.radius).min > discs.map(_.radius).max + 2)
    assert(
      Set("title", "turn rate, rad/s", "lead", "at the best: capture radius = 1.5 m").subsetOf(texts.toSet),
      texts
    )

  test("a map's legend states the standard error of a cell, and no text overlaps its colours"):
    val random = java.util.SplittableRandom(1)
    val noise  = at(2).copy(
      xs = Vector.tabulate(21)(_ / 10.0),
      ys = Vector.tabulate(21)(_ / 10.0),
      cells = Vector.fill(21, 21)(RunningStats.of(16)(Vector.fill(16)(random.nextDouble())))
    )
    // A uniform variable's standard deviation is 1/√12, and that of the mean of 16 is a quarter of it.
    assertEqualsDouble(noise.standardError, 1 / math.sqrt(12) / 4, 0.002)
    val texts = LandscapeFigure(noise, "title", "m", Direction.Minimise).shapes.collect {
      case text: Mark.Text =>
        text.content
    }
    assert(texts.exists(_.startsWith("standard error of a cell 0.07")), texts)

  private def alongOne(means: Vector[Double], best: Double) =
    val xs = means.indices.toVector.map(_.toDouble)
    Landscape(
      SearchSpace(Vector(Axis("gain", 0, xs.last, default = 1))),
      Vector(best),
      0,
      None,
      xs,
      Vector(0.0),
      Vector(means.map(mean => RunningStats(16, mean, 0.16)))
    )

  test("a few distant values do not flatten a curve, which is cut where it leaves the axis"):
    val flat   = Vector.tabulate(30)(at => 10.7 + at * 0.01) ++ Vector(40.0, 80.0)
    val figure = LandscapeFigure(alongOne(flat, 3), "title", "distance, m", Direction.Minimise)
    val ticks  = figure.shapes.collect { case text: Mark.Text => text.content }.flatMap(_.toDoubleOption)
    assert(!ticks.exists(_ > 35), ticks)
    val places = figure.shapes.collect { case Mark.Path(points, _, _, _) => points }.flatten
    assert(places.forall(at => at.y >= 0 && at.y <= figure.height), places)

  test("if the found value is the default, both lines are visible"):
    val figure = LandscapeFigure(alongOne(Vector(3.0, 1, 2), 1), "title", "distance, m", Direction.Minimise)
    val lines  = figure.shapes.collect:
      case Mark.Path(Vector(from, to), Some(stroke), _, _) if from.x == to.x && from.y != to.y => stroke
    val marks = lines.filter(_.width > 1)
    assertEquals(marks.map(_.dash.isEmpty), Vector(true, false), marks)
    assert(marks(0).width > 2 * marks(1).width)

  test("parameters have readable titles, with their units"):
    val names = Seq(
      "turnRateRadPerS",
      "turningRadiusM",
      "most-rad-per-s",
      "drag-per-m",
      "dead-time-s",
      "pursuerMps",
      "gain",
      "s",
      "w12"
    )
    assertEquals(
      names.map(AxisTitle.of(_).text),
      Seq(
        "turn rate, rad/s",
        "turning radius, m",
        "most, rad/s",
        "drag, 1/m",
        "dead time, s",
        "pursuer, m/s",
        "gain",
        "s",
        "w12"
      )
    )

  test("a map's colours end before outliers on the worse side, and the bar marks that end"):
    val even                                               = Vector.tabulate(101)(_ / 10.0)
    val outliers                                           = even.init :+ 1000.0
    def scale(means: Vector[Double], direction: Direction) =
      val found = LandscapeScale.of(means, direction)
      (found.from, found.to, found.beyond)
    assertEquals(scale(even, Direction.Minimise), (0.0, 10.0, Set.empty[ColourScale.End]))
    assertEquals(scale(outliers, Direction.Minimise), (0.0, 9.0, Set(ColourScale.End.High)))
    assertEquals(scale(outliers.map(-_), Direction.Maximise), (-9.0, -0.0, Set(ColourScale.End.Low)))
    assertEquals(scale(outliers, Direction.Maximise), (0.0, 1000.0, Set.empty[ColourScale.End]))
    assertEquals(scale(Vector(1.0, 1.0, 1.0), Direction.Minimise), (1.0, 1.0, Set.empty[ColourScale.End]))
    val texts = LandscapeScale.of(outliers, Direction.Minimise).bar(0, 0, 340, "m").collect:
      case text: Mark.Text => text.content
    assertEquals(texts, Vector("0", "2", "4", "6", "8", "≥ 9", "m"))
