package skein.optimise

/** Eigenvalues and eigenvectors of a symmetric matrix.
  *
  * @param values eigenvalues, in no particular order
  * @param vectors `vectors(row)(k)` is component `row` of the k-th eigenvector, whose length is 1
  */
private[skein] final case class SymmetricEigen(values: Array[Double], vectors: Array[Array[Double]])

private[skein] object SymmetricEigen:
  private val MostSweeps = 64

  /** Computes them by cyclic Jacobi rotations (Golub, Van Loan, "Matrix Computations", 8.5): slow for large
    * matrices, exact to rounding, and bit-identical on all machines.
    *
    * @param matrix the matrix, row by row; its symmetric part is used
    */
  def of(matrix: Array[Array[Double]]): SymmetricEigen =
    val n = matrix.length
    val a = Array.tabulate(n, n)((i, j) => (matrix(i)(j) + matrix(j)(i)) / 2)
    val v = Array.tabulate(n, n)((i, j) => if i == j then 1.0 else 0.0)

    def rotate(p: Int, q: Int): Unit =
      val theta = (a(q)(q) - a(p)(p)) / (2 * a(p)(q))
      val t     = (if theta >= 0 then 1 else -1) / (theta.abs + math.sqrt(theta * theta + 1))
      val c     = 1 / math.sqrt(t * t + 1)
      val s     = t * c
      for k <- 0 until n do
        val (kp, kq) = (a(k)(p), a(k)(q))
        a(k)(p) = c * kp - s * kq
        a(k)(q) = s * kp + c * kq
      for k <- 0 until n do
        val (pk, qk) = (a(p)(k), a(q)(k))
        a(p)(k) = c * pk - s * qk
        a(q)(k) = s * pk + c * qk
      for k <- 0 until n do
        val (kp, kq) = (v(k)(p), v(k)(q))
        v(k)(p) = c * kp - s * kq
        v(k)(q) = s * kp + c * kq

    def largest: Double =
      var most = 0.0
      for p <- 0 until n; q <- p + 1 until n do most = most.max(a(p)(q).abs)
      most

    val scale = a.indices.map(i => a(i)(i).abs).maxOption.getOrElse(0.0).max(largest)
    var sweep = 0
    while sweep < MostSweeps && largest > 1e-15 * scale do
      for p <- 0 until n; q <- p + 1 until n if a(p)(q).abs > 1e-16 * scale do rotate(p, q)
      sweep += 1
    SymmetricEigen(Array.tabulate(n)(i => a(i)(i)), v)
