package skein.signal

import skein.units.*

/** The distribution of round trips, given by its inverse cumulative distribution function. */
enum LatencyDistribution:

  case Constant(roundTrip: Span)

  case Uniform(least: Span, most: Span)

  /** The logarithm is normal with standard deviation `sigma`; half of the round trips are shorter than
    * `median`.
    */
  case LogNormal(median: Span, sigma: Double)

  /** Linear interpolation between measured quantiles: `roundTripsMs(i)` ms is the quantile at
    * `probabilities(i)`. Both ascend; the probabilities go from 0 to 1.
    */
  case Quantiles(probabilities: Vector[Double], roundTripsMs: Vector[Double])

  /** The quantile of the round trips: a fraction `p` of them does not exceed it.
    *
    * @param p the share, in [0, 1]; a log-normal distribution has no largest value and is cut at 1 − 10^−12^
    */
  def quantile(p: Double): Span = this match
    case Constant(roundTrip)      => roundTrip
    case Uniform(least, most)     => least + Span.ofNanos(math.round((most - least).toNanos * p))
    case LogNormal(median, sigma) =>
      Span.ofMillis(median.toMillis * StrictMath.exp(sigma * NormalQuantile(p.max(1e-12).min(1 - 1e-12))))
    case Quantiles(probabilities, roundTripsMs) =>
      val above = probabilities.indexWhere(_ >= p).max(1)
      val share = (p - probabilities(above - 1)) / (probabilities(above) - probabilities(above - 1))
      Span.ofMillis(roundTripsMs(above - 1) + share * (roundTripsMs(above) - roundTripsMs(above - 1)))

  def mean: Span = this match
    case Constant(roundTrip)      => roundTrip
    case Uniform(least, most)     => (least + most) / 2
    case LogNormal(median, sigma) => Span.ofMillis(median.toMillis * StrictMath.exp(sigma * sigma / 2))
    case Quantiles(probabilities, roundTripsMs) =>
      val pieces = probabilities.zip(roundTripsMs).sliding(2).collect:
        case Vector((p0, t0), (p1, t1)) => (p1 - p0) * (t0 + t1) / 2
      Span.ofMillis(pieces.sum)

  /** Jitter: the 99 % quantile minus the median. */
  def jitter: Span = quantile(0.99) - quantile(0.5)

object LatencyDistribution:

  /** The distribution of measured round trips in ms, at least one, in any order: the shortest is the quantile
    * at 0, the longest at 1, and the others are evenly spaced between.
    */
  def ofSamples(roundTripsMs: Seq[Double]): LatencyDistribution =
    require(roundTripsMs.nonEmpty, "a latency distribution needs at least one sample")
    if roundTripsMs.sizeIs == 1 then Constant(Span.ofMillis(roundTripsMs.head))
    else
      val last = roundTripsMs.size - 1
      Quantiles(Vector.tabulate(last + 1)(_.toDouble / last), roundTripsMs.sorted.toVector)

  private val published = Vector(0, 1, 5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 95, 99, 100).map(_ / 100.0)

  /** Round trips of the paper's direct link: quantiles of its 935 published samples (mean 36.8 ms, sd 10.7
    * ms).
    */
  val Direct: LatencyDistribution = Quantiles(
    published,
    Vector(17.8, 20.8, 22.4, 23.8, 26.1, 28.2, 31.2, 35.9, 40.1, 44.0, 47.6, 51.3, 53.8, 58.3, 85.4)
  )

  /** Round trips of the paper's VPN while it was busy: quantiles of the first 393 of its 935 published
    * samples (mean 102.8 ms, sd 25.6 ms). The paper's flights over the VPN were in this state.
    */
  val Vpn: LatencyDistribution = Quantiles(
    published,
    Vector(38.3, 53.7, 64.8, 74.2, 81.3, 87.2, 94.9, 99.4, 106.3, 113.2, 124.8, 137.9, 148.2, 165.5, 207.4)
  )
