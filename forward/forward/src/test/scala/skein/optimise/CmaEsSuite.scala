package skein.optimise

import skein.signal.SplitMix64

class CmaEsSuite extends munit.FunSuite:
  private def minimised(
      f: Vector[Double] => Double,
      start: Vector[Double],
      population: Int,
      generations: Int,
      seed: Long = 1
  ): Vector[CmaEs.State] =
    val cma = CmaEs(start.size, population, seed)
    Iterator
      .iterate(cma.start(start, 0.5)): state =>
        val samples = cma.sample(state)
        cma.next(state, samples, samples.map(f))
      .take(generations + 1)
      .toVector

  private def sphere(x: Vector[Double])    = x.map(v => v * v).sum
  private def ellipsoid(x: Vector[Double]) =
    x.zipWithIndex.map((v, i) => math.pow(1e6, i / (x.size - 1.0)) * v * v).sum
  private def rosenbrock(x: Vector[Double]) =
    x.zip(x.tail).map((a, b) => 100 * math.pow(b - a * a, 2) + math.pow(1 - a, 2)).sum

  for seed <- 1 to 3 do
    test(s"the search reaches the minimum of an 8-dimensional sphere in 1,500 evaluations, seed $seed"):
      assert(sphere(minimised(sphere, Vector.fill(8)(1.0), 10, 150, seed).last.mean) < 1e-8)

    test(s"an ellipsoid with a condition of a million takes at most 6,000 evaluations, seed $seed"):
      val states = minimised(ellipsoid, Vector.fill(8)(1.0), 10, 600, seed)
      assert(ellipsoid(states.last.mean) < 1e-8, ellipsoid(states.last.mean))

    test(s"the search follows the valley of Rosenbrock's function in 5 dimensions, seed $seed"):
      val last = minimised(rosenbrock, Vector.fill(5)(0.0), 12, 500, seed).last.mean
      assert(rosenbrock(last) < 1e-8, rosenbrock(last))

  test("on the ellipsoid the covariance becomes the inverse of the Hessian, up to a factor"):
    val c      = minimised(ellipsoid, Vector.fill(4)(1.0), 16, 250).last.covariance
    val ratios = (0 until 4).map(i => c(i)(i) * math.pow(1e6, i / 3.0))
    assert(ratios.max / ratios.min < 10, ratios)

  test("the search depends only on the order of a function's values, not on their scale"):
    val plain  = minimised(sphere, Vector.fill(3)(1.0), 8, 30).last
    val scaled = minimised(x => math.exp(sphere(x)) * 1e9, Vector.fill(3)(1.0), 8, 30).last
    assertEquals(scaled, plain)

  test("a symmetric matrix is the product of its eigenvectors and eigenvalues"):
    val source = SplitMix64(11)
    for n <- Seq(1, 2, 7, 20) do
      val half   = Array.fill(n, n)(source.nextDouble() - 0.5)
      val matrix = Array.tabulate(n, n)((i, j) => half(i)(j) + half(j)(i))
      val eigen  = SymmetricEigen.of(matrix)
      for i <- 0 until n; j <- 0 until n do
        val rebuilt = (0 until n).map(k => eigen.values(k) * eigen.vectors(i)(k) * eigen.vectors(j)(k)).sum
        assertEqualsDouble(rebuilt, matrix(i)(j), 1e-12, s"n $n, seed 11")
        val product = (0 until n).map(k => eigen.vectors(i)(k) * eigen.vectors(j)(k)).sum
        assertEqualsDouble(product, if i == j then 1 else 0, 1e-12, s"n $n, seed 11")
