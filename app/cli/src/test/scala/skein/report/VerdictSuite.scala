package skein.report

import skein.measure.{Deviation, Distribution}

class VerdictSuite extends munit.FunSuite:

  private def deviation(
      loop: String,
      link: String,
      share: Double,
      clock: String = "real",
      scenario: String = ""
  ) =
    Deviation(loop, loop, link, clock, Distribution.of(Seq(share)).get, scenario)

  test("each link's loops are listed from the largest deviation to the smallest, and the worst link last"):
    val said = Verdict.sentences(Seq(
      deviation("stream", "vpn", 0.298),
      deviation("predictive", "vpn", -0.0104),
      deviation("stream", "direct", 0.081),
      deviation("predictive", "direct", -0.003)
    ))
    assertEquals(
      said,
      Vector(
        "Over direct, off the truth by: stream 8.1 %, predictive 0.3 %.",
        "Over vpn, off the truth by: stream 29.8 %, predictive 1.0 %."
      )
    )

  test(
    "the worst link is that of the loop with the largest deviation, and live flights follow virtual ones"
  ):
    val said = Verdict.sentences(Seq(
      deviation("stream", "far", 0.3),
      deviation("predictive", "far", 0.01),
      deviation("stream", "near", -0.2),
      deviation("predictive", "near", 0.1),
      deviation("stream", "far", 0.9, "virtual"),
      deviation("predictive", "far", 0.8, "virtual")
    ))
    assertEquals(
      said,
      Vector(
        "Over far in virtual time, off the truth by: stream 90.0 %, predictive 80.0 %.",
        "Over near, off the truth by: stream 20.0 %, predictive 10.0 %.",
        "Over far, off the truth by: stream 30.0 %, predictive 1.0 %."
      )
    )

  test("live and virtual flights are not mixed"):
    val said = Verdict.sentences(Seq(
      deviation("stream", "vpn", 0.3),
      deviation("predictive", "vpn", 0.01),
      deviation("stream", "vpn", 0.2, "virtual"),
      deviation("predictive", "vpn", 0.02, "virtual")
    ))
    assertEquals(said.count(_.contains("in virtual time")), 1)
    assertEquals(said.size, 2)

  test("each scenario has a sentence of its own"):
    val said = Verdict.sentences(Seq(
      deviation("stream", "vpn", 0.045, scenario = "formation"),
      deviation("predictive", "vpn", 0.01, scenario = "formation"),
      deviation("stream", "vpn", -0.03, scenario = "duel"),
      deviation("predictive", "vpn", 0.02, scenario = "duel")
    ))
    assertEquals(
      said,
      Vector(
        "Over vpn, duel, off the truth by: stream 3.0 %, predictive 2.0 %.",
        "Over vpn, formation, off the truth by: stream 4.5 %, predictive 1.0 %."
      )
    )

  test("with a single loop, or without a paused flight, there is no sentence"):
    assertEquals(Verdict.sentences(Seq(deviation("stream", "vpn", 0.3))), Vector.empty)
    assertEquals(Verdict.sentences(Nil), Vector.empty)
