package skein.identify

import scala.util.Random

class LinearSystemSuite extends munit.FunSuite:
  private def times(matrix: Array[Array[Double]], x: Array[Double]) =
    matrix.map(row => row.lazyZip(x).map(_ * _).sum)

  test("the solution satisfies the equations, whichever row has the pivot"):
    val random = Random(7)
    for n <- 1 to 6; _ <- 1 to 20 do
      val matrix = Array.fill(n, n)(random.nextGaussian())
      // Zeros on the diagonal need other rows' pivots.
      if n > 1 then for i <- 0 until n do matrix(i)(i) = 0
      val right = Array.fill(n)(random.nextGaussian())
      LinearSystem.solve(matrix, right) match
        case Some(x) =>
          times(matrix, x).zip(right).foreach((told, wanted) => assertEqualsDouble(told, wanted, 1e-6, s"$n"))
        case None => fail(s"$n: ${matrix.map(_.toVector).toVector}")

  test("a matrix times its inverse is the identity"):
    val matrix  = Array(Array(2.0, 1, 0), Array(0.0, 3, 1), Array(1.0, 0, 4))
    val columns = LinearSystem.inverseColumns(matrix).get
    for i <- 0 until 3; (value, j) <- times(matrix, columns(i)).zipWithIndex do
      assertEqualsDouble(value, if i == j then 1 else 0, 1e-12)

  test("a singular matrix, or one with pivots that count as 0, has no solution and no inverse"):
    val singular = Array(Array(1.0, 2), Array(2.0, 4))
    assertEquals(LinearSystem.solve(singular, Array(1.0, 1)).map(_.toVector), None)
    assert(LinearSystem.inverseColumns(singular).isEmpty)
    assert(LinearSystem.solve(Array(Array(Double.NaN)), Array(1.0)).isEmpty)
    val small = Array(Array(1e-10))
    assert(LinearSystem.solve(small, Array(1.0), least = 1e-9).isEmpty)
    assert(LinearSystem.solve(small, Array(1.0)).isDefined)
