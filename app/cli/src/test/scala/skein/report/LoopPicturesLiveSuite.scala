package skein.report

import java.nio.file.{Files, Path}
import skein.docs.Documentation
import skein.loop.{GraphLayout, LoopKind, OwnLoop}
import skein.plot.Svg
import skein.scenario.PaperDuel
import skein.testing.Unhurried

/** The graphs in `docs/pictures` equal the running ones. `cli/Test/runMain skein.report.drawLoops` draws them
  * again.
  */
class LoopPicturesLiveSuite extends munit.FunSuite, Unhurried:

  test("the documentation's graphs are drawn from running loops"):
    for (file, text) <- LoopPicturesLiveSuite.drawn do
      assertEquals(Files.readString(file), text, s"$file: draw it anew")

  test("parts are placed after their predecessors, except for feedback edges"):
    val turns = LoopPicturesLiveSuite.graphs.map: (kind, graph) =>
      val spots = GraphLayout.of(graph)
      assertEquals(spots.keySet, graph.stages.toSet)
      assertEquals(spots.values.toSet.size, graph.stages.size, "two parts in one place")
      kind -> graph.edges.filter(edge => spots(edge.to).column <= spots(edge.from).column).map(_.from).toSet
    assert(turns.exists(_._2 == Set("feed back")), turns.toString)
    assertEquals(turns.filterNot(turned => turned._2 == Set("feed back")), Vector.empty)

  test("with plans in packets, the graph has a stage that foresees"):
    val loops = Seq(false, true).map(LoopPictures.Loop(LoopKind.Predictive, LoopPicturesLiveSuite.fleet, _))
    val drawn = LoopPictures.graphs(loops).map((loop, graph) =>
      loop.isInPacket -> graph.stages.exists(_.startsWith("foresee"))
    )
    assertEquals(drawn.toMap, Map(false -> false, true -> true))
    assertEquals(
      LoopPictures.drawn(loops).map(_.name),
      Vector("graph-predictive", "graph-predictive-in-packet")
    )

object LoopPicturesLiveSuite:
  private val kinds = LoopKind.values.toVector.filterNot(_ == LoopKind.Paused)
  private val fleet = PaperDuel().fleet

  private lazy val figures = LoopPictures.drawn(kinds.map(LoopPictures.Loop(_, fleet)))

  def drawn: Vector[(Path, String)] = figures.map(figure =>
    Documentation.root.resolve(s"docs/pictures/${figure.name}.svg") -> Svg.file(figure.drawing, figure.title)
  )

  def graphs: Vector[(LoopKind | OwnLoop, skein.loop.LoopGraph)] =
    LoopPictures.graphs(kinds.map(LoopPictures.Loop(_, fleet))).map((loop, graph) => (loop.kind, graph))

@main def drawLoops(): Unit =
  for (file, text) <- LoopPicturesLiveSuite.drawn do
    Files.writeString(file, text): Unit
    println(file)
