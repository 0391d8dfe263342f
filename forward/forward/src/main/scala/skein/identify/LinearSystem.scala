package skein.identify

/** Solves small dense systems of linear equations. */
private[skein] object LinearSystem:
  /** Solves A x = b by Gaussian elimination with pivoting.
    *
    * @param matrix the matrix A, n × n, row by row
    * @param right the vector b
    * @param least a pivot whose magnitude is not above this counts as 0
    * @return x, or None if A has no inverse
    */
  def solve(matrix: Array[Array[Double]], right: Array[Double], least: Double = 0): Option[Array[Double]] =
    val n          = right.length
    val m          = Array.tabulate(n)(i => matrix(i) :+ right(i))
    var isSingular = false
    var column     = 0
    while column < n && !isSingular do
      val pivot = (column until n).maxBy(row => math.abs(m(row)(column)))
      val kept  = m(pivot)
      m(pivot) = m(column); m(column) = kept
      isSingular = !(math.abs(kept(column)) > least)
      if !isSingular then
        for row <- 0 until n if row != column do
          val factor = m(row)(column) / kept(column)
          for k <- column to n do m(row)(k) -= factor * kept(k)
      column += 1
    Option.unless(isSingular)(Array.tabulate(n)(i => m(i)(n) / m(i)(i)))

  /** The columns of A⁻¹, each computed by [[solve]]; None if A has no inverse. */
  def inverseColumns(matrix: Array[Array[Double]], least: Double = 0): Option[Array[Array[Double]]] =
    val n       = matrix.length
    val columns =
      Array.tabulate(n)(column =>
        solve(matrix, Array.tabulate(n)(i => if i == column then 1.0 else 0.0), least)
      )
    Option.when(columns.forall(_.isDefined))(columns.flatten)
