package skein.plot

class PlotAxisSuite extends munit.FunSuite:

  test("an axis around values ends at ticks of 1, 2 or 5 times a power of ten"):
    val axis = PlotAxis.around("m", 0, 47.9)
    assertEquals((axis.from, axis.to), (0.0, 50.0))
    assertEquals(axis.ticks.map(axis.text), Vector("0", "10", "20", "30", "40", "50"))

  test("ticks have as many decimals as needed, and zero has no minus"):
    val axis = PlotAxis.exactly("s", -0.25, 0.25)
    assertEquals(axis.ticks.map(axis.text), Vector("-0.2", "-0.1", "0.0", "0.1", "0.2"))

  test("an axis can also be made for equal values"):
    val axis = PlotAxis.around("ms", 0, 0)
    assert(axis.from < axis.to)

  test("an axis maps its ends to 0 and 1"):
    val axis = PlotAxis.exactly("m", -10, 30)
    assertEqualsDouble(axis.share(-10), 0, 1e-12)
    assertEqualsDouble(axis.share(0), 0.25, 1e-12)
    assertEqualsDouble(axis.share(30), 1, 1e-12)
