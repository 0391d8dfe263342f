package skein.signal

class StudentQuantileSuite extends munit.FunSuite:
  test("quantiles above the table are those of tables with more rows"):
    for (degrees, expected) <- Seq(31 -> 2.0395, 40 -> 2.0211, 60 -> 2.0003, 120 -> 1.9799, 1000 -> 1.9623) do
      assertEqualsDouble(StudentQuantile.twoSided95(degrees), expected, 1e-4)
