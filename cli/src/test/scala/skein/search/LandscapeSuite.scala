package skein.search

import skein.optimise.{Evaluator, RunningStats}
import skein.plot.Mark
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

  test("of many parameters the two are drawn that matter most, the others at the best"):
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
    val drawing = LandscapeFigure(land, "title", "value")
    val texts   = drawing.shapes.collect { case text: Mark.Text => text.content }
    assert(texts.contains("title") && texts.contains("x") && texts.contains("value"), texts)
