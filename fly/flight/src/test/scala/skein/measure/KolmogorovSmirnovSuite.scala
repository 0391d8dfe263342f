package skein.measure

import scala.util.Random

class KolmogorovSmirnovSuite extends munit.FunSuite:
  private def distance(one: Double*)(other: Double*): Double =
    KolmogorovSmirnov.distance(Distribution.of(one).get, Distribution.of(other).get)

  test("equal samples have a distance of 0, however often each value occurs"):
    assertEquals(distance(1, 2, 3)(3, 1, 2), 0.0)
    assertEquals(distance(0, 0, 0)(0), 0.0)
    assertEquals(distance(1, 2)(1, 1, 2, 2), 0.0)

  test("samples that lie wholly apart have a distance of 1"):
    assertEquals(distance(1, 2, 3)(4, 5), 1.0)
    assertEquals(distance(7)(6.999), 1.0)

  test("the distance is the largest gap of the cumulative shares"):
    // By hand: after 2, half of the one and none of the other.
    assertEqualsDouble(distance(1, 2, 3, 4)(3, 4, 5, 6), 0.5, 1e-12)
    // After 1: 3/4 against 1/4; ties are counted on both sides before the gap is taken.
    assertEqualsDouble(distance(1, 1, 1, 2)(1, 2, 2, 2), 0.5, 1e-12)
    // After 2: 2/3 against 0; after 4: 1 against 1/2.
    assertEqualsDouble(distance(1, 2, 4)(3, 4, 5, 6), 2 / 3.0, 1e-12)

  test("the distance is symmetric, independent of scale, and equal to a search over all values"):
    val random = Random(11)
    for _ <- 1 to 50 do
      val one   = Vector.fill(1 + random.nextInt(30))(random.nextInt(20).toDouble)
      val other = Vector.fill(1 + random.nextInt(30))(random.nextInt(20).toDouble + 3)
      def share(samples: Vector[Double], value: Double) = samples.count(_ <= value) / samples.size.toDouble
      val searched = (one ++ other).map(value => math.abs(share(one, value) - share(other, value))).max
      assertEqualsDouble(distance(one*)(other*), searched, 1e-12)
      assertEqualsDouble(distance(other*)(one*), searched, 1e-12)
      assertEqualsDouble(distance(one.map(_ * 7)*)(other.map(_ * 7)*), searched, 1e-12)

  test("values within a tolerance of one another count as equal"):
    def within(one: Double*)(other: Double*) =
      KolmogorovSmirnov.distance(Distribution.of(one).get, Distribution.of(other).get, 1)
    assertEquals(within(100, 100, 100)(100.9, 99.1), 0.0)
    assertEquals(within(100, 100)(101.1), 1.0)
    // By hand: half of the one come up to 1, none of the other up to 2.
    assertEqualsDouble(within(1, 5)(5, 5.5), 0.5, 1e-12)
    val random = Random(12)
    for _ <- 1 to 50 do
      val one   = Vector.fill(1 + random.nextInt(30))(random.nextInt(20).toDouble)
      val other = Vector.fill(1 + random.nextInt(30))(random.nextInt(20).toDouble + 3)
      def share(samples: Vector[Double], value: Double) = samples.count(_ <= value) / samples.size.toDouble
      val searched = one.map(value => share(one, value) - share(other, value + 1))
        ++ other.map(value => share(other, value) - share(one, value + 1))
      assertEqualsDouble(within(one*)(other*), searched.max.max(0), 1e-12)
