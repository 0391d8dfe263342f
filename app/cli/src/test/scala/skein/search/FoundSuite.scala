package skein.search

import skein.optimise.{Direction, RunningStats, Search, SearchMethod, SearchState}
import skein.policy.{Axis, SearchSpace}

class FoundSuite extends munit.FunSuite:

  private val start: SearchState =
    Search(SearchSpace(Vector(Axis("x", 0, 3, 1))), SearchMethod.Grid(3, 1), Direction.Minimise, 1).start
  private val paper = Baseline("paper", "chase", Vector("x" -> 1.0), "chase x=1")

  private def around(mean: Double) = RunningStats(4, mean, 0.02)

  private def doubt(best: Double, mean: Double, direction: Direction = Direction.Minimise) =
    Found(start, Vector(best), around(mean), around(10)).doubt(paper, direction)

  test("a best that is better than the baseline is not doubted"):
    assertEquals(doubt(2, 9), None)
    assertEquals(doubt(2, 11, Direction.Maximise), None)

  test("a best whose interval overlaps the baseline's is doubted"):
    assert(doubt(2, 10.1).exists(_.contains("the intervals of the best and of chase x=1 overlap")))

  test("a best that is worse than the baseline is reported"):
    assert(doubt(2, 11).exists(_.startsWith("the best is worse than chase x=1 on these 4 episodes")))
    assert(doubt(2, 9, Direction.Maximise).exists(_.startsWith("the best is worse")))

  test("the baseline itself, found again, is named"):
    assertEquals(doubt(1, 10), Some("nothing better than chase x=1 was found"))
