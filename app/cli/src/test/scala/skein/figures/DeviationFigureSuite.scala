package skein.figures

import skein.measure.{Deviation, Distribution}
import skein.plot.Mark

class DeviationFigureSuite extends munit.FunSuite:

  private def texts(clocks: String*): Set[String] =
    val deviations =
      clocks.map(clock => Deviation("stream", "stream", "vpn", clock, Distribution.of(Seq(0.3)).get))
    DeviationFigure(deviations.toVector).get.shapes.collect { case text: Mark.Text => text.content }.toSet

  test("the picture distinguishes live flights from flights in virtual time"):
    assert(Set("live", "in virtual time").subsetOf(texts("real", "virtual")))
    assertEquals(texts("virtual"), texts("real") -- Set("live", "in virtual time"))
