package skein.plot

class LegendSuite extends munit.FunSuite:
  private val axis  = PlotAxis.exactly("x", 0, 1)
  private val panel = Panel(axis, axis, left = 50, top = 34, width = 600, height = 100)
  private val bare  = Drawing(680, 180, panel.axes)

  private def titled(count: Int): Drawing =
    val items = Vector.tabulate(count)(i => Legend.line(s"sequential, solver $i", Stroke(Colour(i), 2)))
    Legend.titled(panel, "vpn link", bare, items*)

  private def labels(drawing: Drawing) =
    drawing.shapes.collect { case text: Mark.Text if text.content.startsWith("seq") => text.at }

  test("a legend is to the right of the title, or in rows below if it is too long"):
    val short = titled(2)
    assertEquals((short.height, labels(short).size), (bare.height, 2))
    assert(labels(short).forall(at => at.y < panel.top && at.x > panel.left + 100))
    val long = titled(12)
    assertEquals(labels(long).size, 12)
    assert(labels(long).forall(at => at.y > bare.height && at.y < long.height))
    assert(labels(long).forall(at => at.x > panel.left && at.x < panel.right - 100))
    assertEquals(labels(long).distinct.size, 12)
