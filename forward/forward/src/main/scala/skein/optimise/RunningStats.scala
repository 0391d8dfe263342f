package skein.optimise

import skein.signal.NormalQuantile

/** Count and mean of values, and the sum of their squared deviations from the mean. */
final case class RunningStats(count: Int, mean: Double, squares: Double):

  /** The statistics of both sets of values together (Chan, Golub, LeVeque, "Updating formulae and a pairwise
    * algorithm for computing sample variances", 1979).
    */
  def +(other: RunningStats): RunningStats =
    if count == 0 then other
    else if other.count == 0 then this
    else
      val total = count + other.count
      val apart = other.mean - mean
      RunningStats(
        total,
        mean + apart * other.count / total,
        squares + other.squares + apart * apart * count * other.count / total
      )

  /** Whether both are bit-identical; NaN equals NaN. */
  def isSame(other: RunningStats): Boolean =
    count == other.count && mean.equals(other.mean) && squares.equals(other.squares)

  /** Standard deviation of the values; 0 for fewer than two. */
  def sd: Double = if count < 2 then 0.0 else math.sqrt(squares / (count - 1))

  /** Half width of the mean's 95 % confidence interval, by the normal approximation. */
  def halfWidth95: Double =
    if count == 0 then Double.PositiveInfinity else NormalQuantile.TwoSided95 * sd / math.sqrt(count)

  /** Half width of the mean's 95 % confidence interval for a few normally distributed values, by Student's
    * distribution; infinite for fewer than two values.
    */
  def studentHalfWidth95: Double =
    if count < 2 then Double.PositiveInfinity
    else if count - 2 < RunningStats.student.length then
      RunningStats.student(count - 2) * sd / math.sqrt(count)
    else halfWidth95

object RunningStats:
  /** The 97.5 % quantiles of Student's distribution for 1, 2, … degrees of freedom (Abramowitz and Stegun,
    * "Handbook of mathematical functions", table 26.10).
    */
  private val student = Vector(
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201,
    2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056,
    2.052, 2.048, 2.045, 2.042
  )

  /** Whether the statistics are pairwise [[RunningStats.isSame identical]]. */
  def areSame(some: Seq[RunningStats], others: Seq[RunningStats]): Boolean =
    some.corresponds(others)(_.isSame(_))

  val empty: RunningStats = RunningStats(0, 0, 0)

  /** The statistics of `count` values, each computed from its index. */
  def of(count: Int)(value: Int => Double): RunningStats =
    var sum = 0.0
    var i   = 0
    while i < count do
      sum += value(i)
      i += 1
    val mean    = if count == 0 then 0.0 else sum / count
    var squares = 0.0
    i = 0
    while i < count do
      val off = value(i) - mean
      squares += off * off
      i += 1
    RunningStats(count, mean, squares)
