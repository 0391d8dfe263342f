package skein.measure

import skein.signal.LatencyDistribution
import skein.units.Decimals.significant
import skein.units.Span

/** The profile of a link, fitted to requests over it.
  *
  * @param lossShare share of the requests that were lost
  * @param burst mean number of requests that were lost in a row; None if no more than by chance
  * @param correlatedS correlation time of successive round trips; None if no longer than by chance
  * @param logNormal median in ms, and standard deviation of the logarithm
  * @param distance maximum distance between the log-normal and the measured distribution function
  */
final case class LinkFit(
    samples: Int,
    lossShare: Double,
    burst: Option[Double],
    correlatedS: Option[Double],
    logNormal: (medianMs: Double, sigma: Double),
    distance: Double
):
  /** A profile's text with these losses and this correlation.
    *
    * @param delays the text of the distribution
    */
  def text(delays: String): String =
    // A request is lost if it or its answer is: each direction loses a part of that.
    val oneWay = 1 - math.sqrt(1 - lossShare)
    val loss   = Option.when(lossShare > 0):
      s"loss:${(oneWay * 100).significant(3)}%${burst.fold("")(length => s"/${length.significant(3)}")},"
    val correlated = correlatedS.map(s => s"correlated:${(s * 1000).round}ms,")
    loss.getOrElse("") + correlated.getOrElse("") + delays

  def logNormalText: String =
    text(s"lognormal:${logNormal.medianMs.significant(4)}ms,${logNormal.sigma.significant(3)}")

object LinkFit:
  /** Fits a link.
    *
    * Loss: the fraction of lost requests. Their mean number in a row is fitted if it exceeds that of
    * independent losses, 1/(1 − share), by three standard errors. Correlation: e^(−Δ/τ) between the ranks of
    * successive round trips, which are Δ apart; fitted if it exceeds that of independent ranks by three
    * standard errors. Ranks are used because [[skein.signal.LatencyProfile.Correlated]] holds the share at
    * which the distribution is read.
    */
  def of(traces: Seq[RoundTripTrace]): LinkFit =
    val trips    = traces.flatMap(_.answered).sorted.toVector
    val lost     = traces.map(_.lost)
    val count    = lost.map(_.count(identity)).sum.toDouble
    val share    = count / traces.map(_.size).sum
    val runs     = lost.map(one => one.indices.count(i => one(i) && (i == 0 || !one(i - 1)))).sum
    val length   = count / runs
    val expected = 1 / (1 - share)
    val error    = math.sqrt(share) / (1 - share) / math.sqrt(runs)
    val logs     = trips.map(ms => StrictMath.log(ms.max(1e-3)))
    val centre   = logs.sum / logs.size
    val sigma    = math.sqrt(logs.map(log => (log - centre) * (log - centre)).sum / logs.size).min(3)
    val fitted   = LatencyDistribution.LogNormal(Span.ofMillis(StrictMath.exp(centre)), sigma)
    // Against the middle between the steps of the measured distribution function.
    val distance = trips.indices.map: i =>
      val p = (i + 0.5) / trips.size
      (shareBelow(trips, fitted.quantile(p).toMillis) - p).abs
    LinkFit(
      traces.map(_.size).sum,
      share,
      Option.when(runs > 0 && length > expected + 3 * error)(length),
      correlation(traces, trips),
      (StrictMath.exp(centre), sigma),
      distance.max
    )

  private def correlation(traces: Seq[RoundTripTrace], sorted: Vector[Double]): Option[Double] =
    def rank(ms: Double) = shareBelow(sorted, ms) - 0.5
    val pairs            =
      for
        trace <- traces
        requests = trace.roundTripsMs.zip(trace.sentAtS)
        ((one, oneAtS), (next, nextAtS)) <- requests.zip(requests.drop(1))
        before                           <- one
        after                            <- next
      yield (rank(before), rank(after), nextAtS - oneAtS)
    if pairs.sizeIs < 10 || sorted.head == sorted.last then None
    else
      val square  = pairs.map((a, _, _) => a * a).sum
      val similar = pairs.map((a, b, _) => a * b).sum / square
      val everyS  = pairs.map(_._3).sorted.apply(pairs.size / 2)
      Option.when(
        everyS > 0 && similar > 3 / math.sqrt(pairs.size)
      )(-everyS / StrictMath.log(similar.min(0.999)))

  /** The share of the sorted values below a value, half of those equal to it included. */
  private def shareBelow(sorted: Vector[Double], value: Double): Double =
    def first(isBeyond: Double => Boolean) =
      var (low, high) = (0, sorted.size)
      while low < high do
        val middle = (low + high) / 2
        if isBeyond(sorted(middle)) then high = middle else low = middle + 1
      low
    (first(_ >= value) + first(_ > value)) / 2.0 / sorted.size
