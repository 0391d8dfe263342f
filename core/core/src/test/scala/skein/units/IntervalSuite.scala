package skein.units

class IntervalSuite extends munit.FunSuite:

  test("a half width has two significant digits, and the mean is rounded to the last of them"):
    val shown = Seq(
      (10.69213, 0.003406),
      (10.7, 0.007061),
      (20.1349, 0.01611),
      (-0.5, 0.0996),
      (0.0004, 0.12),
      (1234.5, 123.4),
      (3.0, 1.0),
      (0.00102, 0.0000234)
    ).map(Interval.of(_, _).text)
    assertEquals(
      shown,
      Seq(
        "10.6921 ± 0.0034",
        "10.7000 ± 0.0071",
        "20.135 ± 0.016",
        "-0.50 ± 0.10",
        "0.00 ± 0.12",
        "1230 ± 120",
        "3.0 ± 1.0",
        "0.001020 ± 0.000023"
      )
    )

  test("with a half width that is 0, infinite or huge, the mean has up to four digits"):
    assertEquals(Interval.of(8.31649e300, 1.25e298).text, "8.316e300 ± 1.3e298")
    assertEquals(Interval.of(8.31049, 0).text, "8.31 ± 0")
    assertEquals(Interval.of(8.31649, Double.PositiveInfinity).text, "8.316 ± Infinity")
    assertEquals(Interval.of(Double.NaN, 1.25).text, "NaN ± 1.3")
