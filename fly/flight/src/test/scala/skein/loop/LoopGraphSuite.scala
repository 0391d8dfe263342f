package skein.loop

class LoopGraphSuite extends munit.FunSuite:
  private def named(names: String*) = names.toVector.map(name => Option.when(name.nonEmpty)(name))

  test("operators of one name are one part, and what leads within it is no edge"):
    val graph = LoopGraph.of(named("sense", "sense", "view"), Vector((0, 1), (1, 2)))
    assertEquals(graph, LoopGraph(Vector("sense", "view"), Vector(("sense", "view"))))

  test("what leads through operators without a name leads on, also where they branch and turn back"):
    val graph =
      LoopGraph.of(named("a", "", "", "b", "c"), Vector((0, 1), (1, 2), (2, 1), (2, 3), (1, 4), (4, 0)))
    assertEquals(
      graph.edges.toSet,
      Set(("a", "b"), ("a", "c"), ("c", "a")).map((from, to) => (from = from, to = to))
    )
