package skein.identify

/** Levenberg and Marquardt's method within bounds, with a Jacobian by central differences.
  *
  * Source: Marquardt, SIAM J. Appl. Math. 11 (1963); damping by the diagonal of JᵀJ.
  */
private[identify] object LeastSquares:

  /** The result of a fit.
    *
    * @param jacobian at the solution: by parameter, then by residual
    * @param isConverged whether no step improved it, or the last one was small or made hardly a difference;
    *   else [[MostIterations]] were reached
    */
  final case class Solution(
      parameters: Array[Double],
      residuals: Array[Double],
      jacobian: Array[Array[Double]],
      isConverged: Boolean
  )

  private val MostIterations = 200

  /** A step that changes no parameter by more than this share ends the search. */
  private val SmallStep = 1e-7

  private val SmallGain = 1e-6

  /** Minimises the sum of squares.
    *
    * @param residuals a pure function of the parameters; always of one size, more than the parameters
    */
  def solve(start: Array[Double], least: Array[Double], most: Array[Double])(
      residuals: Array[Double] => Array[Double]
  ): Solution =
    def clamped(values: Array[Double]) = values.indices.map(i => values(i).max(least(i)).min(most(i))).toArray

    def go(at: Array[Double], here: Array[Double], damping: Double, iteration: Int): Solution =
      val jacobian = differences(at, least, most, residuals)
      val normal   = at.indices.map(i => at.indices.map(j => dot(jacobian(i), jacobian(j))).toArray).toArray
      val gradient = at.indices.map(i => -dot(jacobian(i), here)).toArray

      def attempt(damping: Double): Option[(Array[Double], Array[Double], Double)] =
        if damping > 1e12 then None
        else
          val damped = normal.map(_.clone)
          for i <- at.indices do damped(i)(i) += damping * normal(i)(i).max(1e-12)
          LinearSystem.solve(damped, gradient)
            .map(step => clamped(step.zip(at).map(_ + _)))
            .map(next => (next, residuals(next)))
            .collect {
              case (next, there) if dot(there, there) < dot(here, here) => (next, there, damping / 5)
            }
            .orElse(attempt(damping * 4))

      attempt(damping) match
        case None                      => Solution(at, here, jacobian, isConverged = true)
        case Some((next, there, less)) =>
          val isSmall =
            at.indices.forall(i => math.abs(next(i) - at(i)) <= SmallStep * (math.abs(at(i)) + 1e-3))
          if isSmall || iteration == MostIterations then
            val hardlyBetter = dot(there, there) >= (1 - SmallGain) * dot(here, here)
            Solution(next, there, differences(next, least, most, residuals), isSmall || hardlyBetter)
          else go(next, there, less, iteration + 1)

    val from = clamped(start)
    go(from, residuals(from), 1e-3, 1)

  private def differences(
      at: Array[Double],
      least: Array[Double],
      most: Array[Double],
      residuals: Array[Double] => Array[Double]
  ): Array[Array[Double]] =
    at.indices
      .map: i =>
        val step   = 1e-4 * math.abs(at(i)).max(1e-3)
        val (a, b) = ((at(i) - step).max(least(i)), (at(i) + step).min(most(i)))
        val below  = residuals(at.updated(i, a))
        val above  = residuals(at.updated(i, b))
        Array.tabulate(above.length)(k => (above(k) - below(k)) / (b - a))
      .toArray

  def dot(a: Array[Double], b: Array[Double]): Double =
    var sum = 0.0
    var i   = 0
    while i < a.length do
      sum += a(i) * b(i)
      i += 1
    sum
