package skein.report

import skein.measure.Distribution

class TextHistogramSuite extends munit.FunSuite:

  test("every sample is in its bin, and the largest in the last one"):
    val samples = Distribution.of(Vector(0.0, 0.5, 1, 1, 1.5, 8)).get
    assertEquals(
      TextHistogram(samples, "ms"),
      """0.0 … 0.5 ms  █████████████████████████ 1
        |0.5 … 1.0 ms  █████████████████████████ 1
        |1.0 … 1.5 ms  ██████████████████████████████████████████████████ 2
        |1.5 … 2.0 ms  █████████████████████████ 1
        |2.0 … 2.5 ms   0
        |2.5 … 3.0 ms   0
        |3.0 … 3.5 ms   0
        |3.5 … 4.0 ms   0
        |4.0 … 4.5 ms   0
        |4.5 … 5.0 ms   0
        |5.0 … 5.5 ms   0
        |5.5 … 6.0 ms   0
        |6.0 … 6.5 ms   0
        |6.5 … 7.0 ms   0
        |7.0 … 7.5 ms   0
        |7.5 … 8.0 ms  █████████████████████████ 1""".stripMargin
    )
