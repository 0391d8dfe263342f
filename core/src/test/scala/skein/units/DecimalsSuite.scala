package skein.units

import skein.units.Decimals.{brief, signed}

class DecimalsSuite extends munit.FunSuite:

  test("brief numbers have as many digits as they need to be told apart"):
    val shown = Seq(123.4, 10.0, 9.96, 9.94, 1.0, 0.96, 0.94, 0.05, 0.0, -12.3, -0.5).map(_.brief)
    assertEquals(
      shown,
      Seq("123", "10", "10", "9.9", "1.0", "1.0", "0.94", "0.05", "0", "-12", "-0.50")
    )

  test("where the digits change, what is shown does not shrink"):
    assertEquals(Seq(9.95, 0.95, -9.95, -0.95).map(_.brief), Seq("10", "1.0", "-10", "-1.0"))

  test("signed numbers say their sign"):
    assertEquals(Seq(1.25, 0.0, -3.04).map(_.signed(1)), Seq("+1.3", "+0.0", "-3.0"))
