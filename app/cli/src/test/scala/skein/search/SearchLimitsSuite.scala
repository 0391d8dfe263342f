package skein.search

import skein.policy.{Axis, SearchSpace}

class SearchLimitsSuite extends munit.FunSuite:
  private val space = SearchSpace(Vector(Axis("turnRateRadPerS", 0.2, 3.0), Axis("gainPerS", 0.5, 8.0)))

  test("a candidate at limits of its axes is reported with these axes and limits"):
    assertEquals(
      SearchResult.atLimits(space, Vector(2.996, 0.5)),
      Some(
        "the best lies at a limit of what was searched: turnRateRadPerS at the most, 3.0 and gainPerS at the " +
          "least, 0.5; farther on may be better"
      )
    )

  test("a candidate within its limits is not reported"):
    assertEquals(SearchResult.atLimits(space, Vector(2.9, 0.7)), None)
