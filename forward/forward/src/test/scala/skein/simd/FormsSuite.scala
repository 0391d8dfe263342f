package skein.simd

import skein.formula.Untraceable

class FormsSuite extends munit.FunSuite:
  private def counted(mostRefused: Int, accepts: Int => Boolean, most: Int = 64) =
    var compiled = 0
    val forms    = Forms[Integer, Int](_ == _, mostRefused, most): of =>
      compiled += 1
      if accepts(of) then Right(of) else Left(Untraceable(s"$of is odd"))
    (forms, () => compiled)

  test("a refused object is not compiled again, and another object of its class may still be a formula"):
    val (forms, compiled) = counted(mostRefused = 2, _ % 2 == 0)
    val one: Integer      = 1001
    assert(forms(one).isLeft && forms(one).isLeft)
    assertEquals(compiled(), 1)
    assertEquals(forms(1002), Right(1002))
    for odd <- Seq(1003, 1005, 1007) do assertEquals(forms(odd).left.map(_.getMessage), Left(s"$odd is odd"))

  test("if new forms keep coming, recently used ones are kept, and the others are compiled again"):
    val (forms, compiled) = counted(mostRefused = 2, _ => true, most = 10)
    for number <- 1001 to 2000 do
      forms(number): Unit
      assertEquals(forms(1001), Right(1001))
    assertEquals(compiled(), 1000)
    assertEquals(forms(1995), Right(1995))
    assertEquals(compiled(), 1000)
    assertEquals(forms(1900), Right(1900))
    assertEquals(compiled(), 1001)

  test("after the limit of refusals without any form, nothing more is compiled"):
    val (forms, compiled) = counted(mostRefused = 3, _ => false)
    for number <- 1001 to 1020 do assert(forms(number).isLeft)
    assertEquals(compiled(), 3)
