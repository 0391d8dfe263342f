package skein.vehicle

class FirstOrderLagSuite extends munit.FunSuite:
  test("the closed form agrees with small steps of v' = −v / lag"):
    for lagS <- Seq(0.3, 2.66); afterS <- Seq(0.0, 0.1, 1.7) do
      val steps             = 200_000
      val dtS               = afterS / steps
      var (error, carriedS) = (1.0, 0.0)
      for _ <- 1 to steps do
        val middle = error - error / lagS * dtS / 2
        carriedS += middle * dtS
        error -= middle / lagS * dtS
      assertEqualsDouble(FirstOrderLag(lagS).remains(afterS), error, 1e-9, s"lag $lagS s, after $afterS s")
      assertEqualsDouble(
        FirstOrderLag(lagS).carriesS(afterS),
        carriedS,
        1e-9,
        s"lag $lagS s, after $afterS s"
      )

  test("without a lag, no error remains and nothing is carried"):
    assertEquals(FirstOrderLag(0).remains(0.1), 0.0)
    assertEquals(FirstOrderLag(0).carriesS(0.1), 0.0)

  test("a negative lag is refused"):
    interceptMessage[IllegalArgumentException](
      "requirement failed: a lag must not be negative, got -1.0 s"
    )(FirstOrderLag(-1)): Unit
