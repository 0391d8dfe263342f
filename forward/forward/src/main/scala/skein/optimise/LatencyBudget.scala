package skein.optimise

import skein.signal.LatencyDistribution
import skein.units.*

/** An objective as a function of the mean latency and the jitter of a link: a map with one cell per pair.
  *
  * @param meansMs mean round trips, ascending
  * @param jittersMs jitters of the round trip, p99 − p50, ascending
  * @param cells `cells(jitter)(mean)`; None if no log-normal link has such a mean and jitter
  * @param truth the objective under the paused loop, with equal vehicles
  * @param per unit of deviations: the magnitude of `truth`, or 1 for deviations in the objective's own unit
  */
final case class LatencyBudget(
    meansMs: Vector[Double],
    jittersMs: Vector[Double],
    cells: Vector[Vector[Option[RunningStats]]],
    truth: Double,
    per: Double
):
  require(
    truth.isFinite && per > 0,
    s"the truth must be a number, and deviations by more than 0, got $truth, $per"
  )

  /** Relative deviation of a cell from the paused loop's objective: 0.05 is 5 % more. */
  def deviation(jitter: Int, mean: Int): Option[Double] =
    cells(jitter)(mean).map(tally => (tally.mean - truth) / per)

  /** The mean latency up to which, at one jitter, the objective stays within a tolerance of the paused loop's
    * objective. Deviations are interpolated linearly between the cells. A cell without a finite value is
    * outside every tolerance.
    *
    * @param tolerance maximum magnitude of [[deviation]], for example 0.05
    */
  def holdsUpTo(jitter: Int, tolerance: Double): LatencyBudget.Bound = LatencyBudget.holdsUpTo(
    meansMs.indices.flatMap(mean => deviation(jitter, mean).map(meansMs(mean) -> _)).toVector,
    tolerance
  )

object LatencyBudget:
  /** The largest mean latency, ms, at which the tolerance holds. */
  enum Bound:
    case At(meanMs: Double)

    /** The tolerance holds even at the largest latency of the map. */
    case Beyond(meanMs: Double)

    /** The tolerance does not hold even at the smallest latency. */
    case Below(meanMs: Double)

    case Unknown

  /** The mean latency up to which deviations stay within a tolerance to either side, by linear interpolation.
    *
    * @param known mean latencies, ms, ascending, each with its deviation, which is infinite or NaN if there
    *   is no value
    */
  def holdsUpTo(known: Vector[(Double, Double)], tolerance: Double): Bound =
    known.indexWhere((_, off) => !(off.abs <= tolerance)) match
      case -1 if known.isEmpty => Bound.Unknown
      case -1                  => Bound.Beyond(known.last._1)
      case 0                   => Bound.Below(known.head._1)
      case first               =>
        val ((fromMs, fromOff), (toMs, toOff)) = (known(first - 1), known(first))
        if !toOff.isFinite then Bound.At(fromMs)
        else Bound.At(fromMs + (toMs - fromMs) * (toOff.sign * tolerance - fromOff) / (toOff - fromOff))

  /** The link of a cell. Round trips are log-normal with this mean and jitter; without jitter they are
    * constant.
    *
    * @return None if the jitter is so large, relative to the mean, that the standard deviation of the
    *   logarithm would exceed [[MostSigma]]
    */
  def link(meanMs: Double, jitterMs: Double): Option[LatencyDistribution] =
    if jitterMs == 0 then Some(LatencyDistribution.Constant(Span.ofMillis(meanMs)))
    else if meanMs <= 0 || jitterMs > meanMs * jitterOverMean(MostSigma) then None
    else
      var (low, high) = (0.0, MostSigma)
      for _ <- 0 until 60 do
        val middle = (low + high) / 2
        if jitterOverMean(middle) * meanMs < jitterMs then low = middle else high = middle
      val median = meanMs * StrictMath.exp(-low * low / 2)
      Some(LatencyDistribution.LogNormal(Span.ofMillis(median), low))

  /** Jitter (p99 − p50) over mean of a log-normal distribution: e^(−σ²/2)·(e^(z₉₉σ) − 1). It increases with σ
    * up to σ = 2.3.
    */
  private def jitterOverMean(sigma: Double): Double =
    StrictMath.exp(-sigma * sigma / 2) * (StrictMath.exp(Z99 * sigma) - 1)

  /** Maximum of σ; beyond it, a few round trips of seconds would determine the mean. */
  val MostSigma = 1.0

  private val Z99 = 2.3263478740408408
