package skein.margin

import skein.budget.Tolerance
import skein.optimise.LatencyBudget.Bound
import skein.optimise.{LatencyBudget, RunningStats}
import skein.signal.LatencyProfile
import skein.units.Decimals.{fixed, significant}

/** The runs over one link, with their statistics. */
final case class MarginPoint(link: LatencyProfile, runs: Vector[MarginRun]):
  def meanMs: Double = link.meanRoundTrip.toMillis

  val stats: RunningStats =
    val values = runs.flatMap(_.value.toOption)
    RunningStats.of(values.size)(values)

  def without: Vector[MarginRun.NoResult] = runs.flatMap(_.value.left.toOption)

  def violations: Int = runs.filter(_.value.isRight).map(_.violations).sum

  /** Number of runs in which the program failed. */
  def failed: Int = without.count:
    case MarginRun.NoResult.OfProgram(_) => true
    case MarginRun.NoResult.OfMachine(_) => false

  /** Whether the point counts for the curve: it has a value, or the program failed. Runs spoiled by a busy
    * machine do not count.
    */
  def counts: Boolean = stats.count > 0 || failed > 0

  /** Whether the program failed in at least half of the runs that count. */
  def isFailure: Boolean = failed > 0 && failed >= stats.count

/** How a program's result changes with the link's mean round trip.
  *
  * @param reference the point without an emulated link
  * @param points the points over links, by ascending mean round trips
  * @param per the unit of deviations: the reference's size, or 1
  */
final case class MarginCurve private (
    judge: MarginJudge,
    tolerance: Tolerance,
    reference: MarginPoint,
    points: Vector[MarginPoint],
    per: Double
):
  /** Deviation from the reference: 0.05 is 5 % more with a tolerance in per cent; NaN without a value, or if
    * the program failed in half of the runs.
    */
  def deviation(point: MarginPoint): Double =
    if point.stats.count == 0 || point.isFailure then Double.NaN
    else (point.stats.mean - reference.stats.mean) / per

  /** Half width of the deviation's 95 % interval, from the spread of the runs at the point and at the
    * reference, to first order. If deviations are shares of the reference, its error counts by their ratio.
    */
  def halfWidth(point: MarginPoint): Double =
    val ratio = tolerance match
      case Tolerance.Share(_) => (point.stats.mean / reference.stats.mean).abs
      case _                  => 1.0
    math.hypot(point.stats.halfWidth95, ratio * reference.stats.halfWidth95) / per

  /** The mean round trip, ms, up to which the result stays within the tolerance, interpolated linearly. */
  def margin: Bound = holds((off, _) => off)

  /** The margin's 95 % interval: from the first mean round trip at which the result may have left the
    * tolerance, to the first at which it must have.
    */
  def interval: (from: Bound, to: Bound) =
    val (above, below) = (holds(_ + _), holds(_ - _))
    (
      from = if MarginCurve.endMs(above) < MarginCurve.endMs(below) then above else below,
      to = holds((off, half) => off.sign * (off.abs - half).max(0))
    )

  private def holds(off: (Double, Double) => Double): Bound =
    val known = points.filter(_.counts).map: point =>
      (point.meanMs, off(deviation(point), halfWidth(point)))
    LatencyBudget.holdsUpTo((0.0, 0.0) +: known, tolerance.value)

  def sentence: String =
    val value = s"${reference.stats.mean.significant(4)} ${judge.unit}".trim
    val what  =
      s"${judge.name} stays within ${tolerance.text(judge.unit)} of what it is without a link, $value,"
    val before = margin match
      case Bound.At(ms)     => s"$what up to a mean round trip of ${ms.fixed(0)} ms"
      case Bound.Beyond(ms) => s"$what as far as it was flown, to a mean round trip of ${ms.fixed(0)} ms"
      case _                => s"$what over none of these links"
    val failed = points.filter(_.failed > 0).map: point =>
      s"; the program failed in ${point.failed} of ${point.runs.size} runs at ${point.meanMs.fixed(0)} ms"
    s"$before (95 %: ${MarginCurve.text(interval.from)} to ${MarginCurve.text(interval.to)})${failed.mkString}"

object MarginCurve:
  /** @return Left says why there is no curve */
  def of(
      judge: MarginJudge,
      tolerance: Tolerance,
      reference: MarginPoint,
      points: Vector[MarginPoint]
  ): Either[String, MarginCurve] =
    reference.without match
      case why +: _ if reference.stats.count == 0 =>
        Left(s"no run without a link has a result, to compare with: ${why.why}")
      case _ if reference.stats.count == 0 => Left("no run without a link has ended")
      case _                               =>
        tolerance
          .per(reference.stats.mean)
          .left.map(_ =>
            s"${judge.name} is 0 without a link, so no percentage of it can be given; " +
              "--within takes a difference instead"
          )
          .map(MarginCurve(judge, tolerance, reference, points.sortBy(_.meanMs), _))

  private def endMs(bound: Bound): Double = bound match
    case Bound.At(ms)    => ms
    case Bound.Below(ms) => ms
    case _               => Double.PositiveInfinity

  def text(bound: Bound): String = bound match
    case Bound.At(ms)     => s"${ms.fixed(0)} ms"
    case Bound.Beyond(ms) => s"more than ${ms.fixed(0)} ms"
    case Bound.Below(ms)  => s"less than ${ms.fixed(0)} ms"
    case Bound.Unknown    => "unknown"
