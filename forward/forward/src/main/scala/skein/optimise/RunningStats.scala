package skein.optimise

import skein.signal.StudentQuantile
import skein.units.eachBelow

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

  /** Half width of the mean's 95 % confidence interval for normally distributed values; infinite for fewer
    * than two.
    */
  def halfWidth95: Double =
    if count < 2 then Double.PositiveInfinity
    else StudentQuantile.twoSided95(count - 1) * sd / math.sqrt(count)

object RunningStats:
  /** Whether the statistics are pairwise [[RunningStats.isSame identical]]. */
  def areSame(some: Seq[RunningStats], others: Seq[RunningStats]): Boolean =
    some.corresponds(others)(_.isSame(_))

  val empty: RunningStats = RunningStats(0, 0, 0)

  /** The statistics of `count` values, each computed from its index. */
  def of(count: Int)(value: Int => Double): RunningStats =
    var sum = 0.0
    eachBelow(count): i =>
      sum += value(i)
    val mean    = if count == 0 then 0.0 else sum / count
    var squares = 0.0
    eachBelow(count): i =>
      val off = value(i) - mean
      squares += off * off
    RunningStats(count, mean, squares)
