package skein.loop

/** Positions of a loop's parts in a drawing of its graph. */
class GraphLayoutSuite extends munit.FunSuite:

  private def places(stages: String*)(edges: (String, String)*): Map[String, (Int, Double)] =
    GraphLayout
      .of(LoopGraph(stages.toVector, edges.toVector.map((from, to) => (from = from, to = to))))
      .map((name, spot) => name -> (spot.column, spot.row))

  test("a chain is one row, in its order, whatever the names of its parts"):
    assertEquals(
      places("a", "b", "c")("c" -> "b", "b"      -> "a"),
      Map("c"                   -> (0, 0.0), "b" -> (1, 0.0), "a" -> (2, 0.0))
    )

  test("a graph without parts has an empty layout"):
    assertEquals(places()(), Map.empty)

  test(
    "branches stand in one column, each behind its predecessor, and narrower columns are centred"
  ):
    assertEquals(
      places("cast", "x1", "x2", "y1", "y2", "z")(
        "cast" -> "x1",
        "cast" -> "x2",
        "x1"   -> "y2",
        "x2"   -> "y1",
        "y1"   -> "z",
        "y2"   -> "z"
      ),
      Map(
        "cast" -> (0, 0.5),
        "x1"   -> (1, 0.0),
        "x2"   -> (1, 1.0),
        "y2"   -> (2, 0.0),
        "y1"   -> (2, 1.0),
        "z"    -> (3, 0.5)
      )
    )

  test("a part is one column after the last of its predecessors"):
    assertEquals(
      places("a", "b", "c")("a" -> "b", "b"      -> "c", "a"      -> "c"),
      Map("a"                   -> (0, 0.0), "b" -> (1, 0.0), "c" -> (2, 0.0))
    )

  test("a back edge does not move its target, and is drawn below"):
    assertEquals(
      places("back", "sense", "steer", "tell", "view")(
        "sense" -> "view",
        "view"  -> "steer",
        "steer" -> "back",
        "steer" -> "tell",
        "back"  -> "view"
      ),
      Map(
        "sense" -> (0, 0.5),
        "view"  -> (1, 0.5),
        "steer" -> (2, 0.5),
        "tell"  -> (3, 0.0),
        "back"  -> (3, 1.0)
      )
    )

  test("a cycle without a source is laid out, and a self-loop moves no part"):
    assertEquals(places("a", "b")("a" -> "b", "b" -> "a"), Map("a" -> (0, 0.0), "b" -> (1, 0.0)))
    assertEquals(places("a", "b")("a" -> "a", "a" -> "b"), Map("a" -> (0, 0.0), "b" -> (1, 0.0)))

  test("a part is vertically centred on its predecessors"):
    val sources = Seq("a", "b", "c", "d")
    val placed  = places(sources ++ Seq("m", "n")*)((sources.map(_ -> "n") :+ ("c" -> "m"))*)
    // n follows rows 0 to 3, m row 2.
    assertEquals((placed("n"), placed("m")), ((1, 1.0), (1, 2.0)))
