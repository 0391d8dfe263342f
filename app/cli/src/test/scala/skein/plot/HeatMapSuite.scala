package skein.plot

class HeatMapSuite extends munit.FunSuite:
  private val places = Vector.tabulate(21)(i => -1 + 0.1 * i)

  test("the contour of the distance from a point is a circle"):
    val cone   = HeatMap(places, places, places.map(y => places.map(x => Some(math.hypot(x, y)))))
    val pieces = cone.contour(0.55)
    for ((x, y), _) <- pieces do assertEqualsDouble(math.hypot(x, y), 0.55, 0.01)
    val length = pieces.map((a, b) => math.hypot(a._1 - b._1, a._2 - b._2)).sum
    assertEqualsDouble(length, 2 * math.Pi * 0.55, 0.05)

  test("next to a missing value there is no contour and no colour"):
    val holed = HeatMap(places, places, places.map(_ => places.map(x => Option.when(x < 0)(x))))
    assertEquals(holed.contour(0.5), Vector.empty)
    assertEquals(holed.contour(-0.55).size, 20)
    val panel = Panel(PlotAxis.exactly("x", -1, 1), PlotAxis.exactly("y", -1, 1), 0, 0, 100, 100)
    assertEquals(holed.cells(panel, ColourScale.viridis(-1, 0)).size, 10 * 21)

  test("a scale's first and last colours are those of its ends and of values beyond them"):
    val scale = ColourScale.aroundZero(-2, 2)
    assertEquals(scale.of(-9), Colour(0x2166ac))
    assertEquals(scale.of(0), Colour(0xffffff))
    assertEquals(scale.of(2), Colour(0xb2182b))

  test("if all values have one sign, that side has the whole palette"):
    val (above, below) = (ColourScale.aroundZero(0, 3), ColourScale.aroundZero(-3, 0.1))
    assertEquals((above.from, above.to, below.from, below.to), (0.0, 3.0, -3.0, 0.0))
    assertEquals((above.of(0), below.of(0)), (Colour(0xffffff), Colour(0xffffff)))
    assertEquals((above.of(3), below.of(-3)), (Colour(0xb2182b), Colour(0x2166ac)))
