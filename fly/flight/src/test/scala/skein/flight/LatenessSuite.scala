package skein.flight

import skein.units.*

class LatenessSuite extends munit.FunSuite:
  private def ticked(ms: Double*) =
    ms.foldLeft(Lateness())((lateness, by) => lateness.ticked(Span.ofMillis(by)))

  test("a machine with less than one late tick in twenty is not too busy"):
    assertEquals(ticked(Seq.fill(600)(3.0)*).starved, None)
    assertEquals(ticked((Seq.fill(570)(3.0) ++ Seq.fill(30)(80.0))*).starved, None)

  test("a flight with more late ticks is starved, and their share is reported"):
    assertEquals(
      ticked((Seq.fill(500)(3.0) ++ Seq.fill(99)(80.0) :+ 310.0)*).starved,
      Some("the machine was too busy: 17 % of 600 ticks came more than 20 ms late, one 310 ms")
    )

  test("a flight with one very late tick is starved"):
    assertEquals(ticked((Seq.fill(599)(3.0) :+ 499.0)*).starved, None)
    assertEquals(
      ticked((Seq.fill(599)(3.0) :+ 1100.0)*).starved,
      Some("the machine was too busy: 0 % of 600 ticks came more than 20 ms late, one 1100 ms")
    )

  test("a few ticks are too few for a judgement"):
    assertEquals(ticked(Seq.fill(10)(500.0)*).starved, None)
