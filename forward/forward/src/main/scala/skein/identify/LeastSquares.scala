package skein.identify

import java.util.stream.IntStream
import scala.annotation.tailrec
import skein.units.eachBelow

/** Minimises a sum of squares within bounds by Levenberg and Marquardt's method, with a Jacobian by central
  * differences.
  *
  * Source: Marquardt, SIAM J. Appl. Math. 11 (1963); damping by the diagonal of JᵀJ.
  */
private[identify] object LeastSquares:

  /** The result of a fit.
    *
    * @param jacobian the Jacobian at the solution, by parameter, then by residual
    * @param isConverged whether the search ended because no step improved the sum, or because the last step
    *   or its gain was small; false if it ended after [[MostIterations]]
    */
  final case class Solution(
      parameters: Array[Double],
      residuals: Array[Double],
      jacobian: Array[Array[Double]],
      isConverged: Boolean
  )

  private val MostIterations = 200

  /** A step that changes every parameter by less than this fraction ends the search. */
  private val SmallStep = 1e-7

  /** A step that lowers the sum of squares by less than this share ends the search. It is the square root of
    * the precision of a `Double`, as in MINPACK's `lmdif1`.
    */
  private val SmallGain = 1.5e-8

  /** Minimises the sum of squares. If a descent would cross the bound at which a parameter lies, the
    * parameter stays there for that step.
    *
    * @param residuals a pure function of the parameters, called by several threads at a time; always of one
    *   size, which exceeds the number of parameters
    */
  def solve(start: Array[Double], least: Array[Double], most: Array[Double])(
      residuals: Array[Double] => Array[Double]
  ): Solution =
    def clamped(values: Array[Double]) = values.indices.map(i => values(i).max(least(i)).min(most(i))).toArray

    def go(at: Array[Double], here: Array[Double], damping: Double, iteration: Int): Solution =
      val jacobian = differences(at, least, most, residuals)
      val descent  = jacobian.map(-dot(_, here))
      val square   = dot(here, here)
      val free     = at.indices.filterNot: i =>
        at(i) == least(i) && descent(i) < 0 || at(i) == most(i) && descent(i) > 0
      val normal = free.map(i => free.map(j => dot(jacobian(i), jacobian(j))).toArray).toArray

      def stepped(step: Array[Double]): Array[Double] =
        clamped(free.zip(step).foldLeft(at) { case (moved, (i, by)) => moved.updated(i, at(i) + by) })

      def isSmall(next: Array[Double]): Boolean =
        at.indices.forall(i => math.abs(next(i) - at(i)) <= SmallStep * (math.abs(at(i)) + 1e-3))

      @tailrec
      def attempt(damping: Double): Option[(Array[Double], Array[Double], Double)] =
        val damped = normal.map(_.clone)
        for k <- free.indices do damped(k)(k) += damping * normal(k)(k).max(1e-12)
        LinearSystem.solve(damped, free.map(descent(_)).toArray).map(stepped) match
          case Some(next) =>
            val there = residuals(next)
            if dot(there, there) < square then Some((next, there, damping / 5))
            else if isSmall(next) then None
            else attempt(damping * 4)
          case None if damping > 1e12 => None
          case None                   => attempt(damping * 4)

      attempt(damping) match
        case None                      => Solution(at, here, jacobian, isConverged = true)
        case Some((next, there, less)) =>
          val isDone = isSmall(next) || dot(there, there) >= (1 - SmallGain) * square
          if isDone || iteration == MostIterations then
            Solution(next, there, differences(next, least, most, residuals), isDone)
          else go(next, there, less, iteration + 1)

    val from = clamped(start)
    go(from, residuals(from), 1e-3, 1)

  private def differences(
      at: Array[Double],
      least: Array[Double],
      most: Array[Double],
      residuals: Array[Double] => Array[Double]
  ): Array[Array[Double]] =
    IntStream
      .range(0, at.length)
      .parallel()
      .mapToObj: i =>
        val step   = 1e-4 * math.abs(at(i)).max(1e-3)
        val (a, b) = ((at(i) - step).max(least(i)), (at(i) + step).min(most(i)))
        val below  = residuals(at.updated(i, a))
        val above  = residuals(at.updated(i, b))
        Array.tabulate(above.length)(k => (above(k) - below(k)) / (b - a))
      .toArray(Array.ofDim[Array[Double]](_))

  def dot(a: Array[Double], b: Array[Double]): Double =
    var sum = 0.0
    eachBelow(a.length): i =>
      sum += a(i) * b(i)
    sum
