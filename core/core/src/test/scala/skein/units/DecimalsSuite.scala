package skein.units

import skein.units.Decimals.{brief, fixed, significant, signed}

class DecimalsSuite extends munit.FunSuite:

  test("brief numbers have enough digits to be distinguished"):
    val shown = Seq(123.4, 10.0, 9.96, 9.94, 1.0, 0.96, 0.94, 0.05, 0.0, -12.3, -0.5).map(_.brief)
    assertEquals(
      shown,
      Seq("123", "10", "10", "9.9", "1.0", "1.0", "0.94", "0.05", "0", "-12", "-0.50")
    )

  test("brief numbers do not decrease where the number of digits changes"):
    assertEquals(Seq(9.95, 0.95, -9.95, -0.95).map(_.brief), Seq("10", "1.0", "-10", "-1.0"))

  test("signed numbers have a sign"):
    assertEquals(
      Seq(1.25, 0.05, -0.05, -3.04, Double.NaN).map(_.signed(1)),
      Seq("+1.3", "+0.1", "-0.1", "-3.0", "NaN")
    )

  test("a number that rounds to zero has no sign"):
    for number <- Seq(0.0, -0.0, 0.04, -0.04) do
      assertEquals((number.fixed(1), number.signed(1), number.fixed(0)), ("0.0", "0.0", "0"))
    assertEquals((-0.004).brief, "0.00")
    assertEquals((-0.0).significant(3), "0.0")
    assertEquals((-0.04).fixed(1, width = 5), "  0.0")

  test("numbers of hundreds of digits are written as powers of ten"):
    assertEquals(
      Seq(1.23456e300, -2.5e12, 999e9).map(_.fixed(2)),
      Seq("1.235e300", "-2.5e12", "999000000000.00")
    )
    assertEquals(Seq(1e300, 0.0).map(_.fixed(0, width = 7)), Seq("  1e300", "      0"))
    assertEquals((1e300.signed(1), (-1e300).signed(1), 1e300.brief), ("+1e300", "-1e300", "1e300"))
    val numbers = Seq(1e300, 1.23456e300, -4e12, 2e-300, 3e-9, 250000, 0)
    assertEquals(
      numbers.map(_.significant(3)),
      Seq("1e300", "1.23e300", "-4e12", "2e-300", "0.000000003", "250000", "0.0")
    )
    assertEquals(Seq(Double.NaN, Double.NegativeInfinity).map(_.fixed(2)), Seq("NaN", "-Infinity"))
