package skein.loop

class LoopGraphSuite extends munit.FunSuite:
  private def named(names: String*) = names.toVector.map(name => Option.when(name.nonEmpty)(name))

  test("operators of one name form one part, without edges inside it"):
    val graph = LoopGraph.of(named("sense", "sense", "view"), Vector((0, 1), (1, 2)))
    assertEquals(graph, LoopGraph(Vector("sense", "view"), Vector(("sense", "view"))))

  test("edges through operators without a name are joined, also at branches and back edges"):
    val graph =
      LoopGraph.of(named("a", "", "", "b", "c"), Vector((0, 1), (1, 2), (2, 1), (2, 3), (1, 4), (4, 0)))
    assertEquals(
      graph.edges.toSet,
      Set(("a", "b"), ("a", "c"), ("c", "a")).map((from, to) => (from = from, to = to))
    )
