package skein.forward

import skein.signal.{LatencyDistribution, LatencyProfile}
import skein.simd.WorldRandom

/** Delays of links by their latency profiles, for forward simulation. */
object LinkDelays:

  /** The longest round trip that forward simulation supports, s. */
  val LongestRoundTripS = 2.0

  /** The delays of a link, if forward simulation supports it.
    *
    * @return Left states what was expected and what was given
    */
  def checked(link: LatencyProfile): Either[String, Delays] = link match
    case steady: LatencyProfile.Steady           => bounded(steady, steady.roundTrip)
    case alternating: LatencyProfile.Alternating => bounded(alternating, alternating.busy, alternating.quiet)
    case other                                   =>
      Left(
        "expected a link without rate and correlation, which " +
          s"forward simulation does not have, came ${other.name}"
      )

  private def bounded(
      link: LatencyProfile.Steady | LatencyProfile.Alternating,
      roundTrips: LatencyDistribution*
  ): Either[String, Delays] =
    val longestS = roundTrips.map(_.quantile(1).toSeconds).max
    Either.cond(
      longestS <= LongestRoundTripS,
      of(link),
      s"expected round trips of at most $LongestRoundTripS s, came ${link.name} with up to $longestS s"
    )

  /** The delays of a link: half of a sampled round trip each. */
  def of(profile: LatencyProfile.Steady | LatencyProfile.Alternating): Delays = profile match
    case LatencyProfile.Steady(_, roundTrip)                    => DelayTable.of(roundTrip)
    case LatencyProfile.Alternating(_, busy, quiet, lasts, not) =>
      AlternatingDelays(DelayTable.of(busy), DelayTable.of(quiet), lasts.toSeconds, not.toSeconds)

  /** The paper's VPN over a long time: stretches of `vpn` and of `direct`. */
  val vpnMixed: Delays = of(LatencyProfile.vpnMixed)

/** A link that is busy for a while and then quiet for a while; the durations are exponentially distributed,
  * and independent in each world. A flight begins at a random moment.
  */
final case class AlternatingDelays(
    busy: DelayTable,
    quiet: DelayTable,
    busyLastsS: Double,
    quietLastsS: Double
) extends TabledDelays:
  require(busyLastsS > 0 && quietLastsS > 0, s"stretches must be positive: $busyLastsS, $quietLastsS s")

  def maxS: Float = busy.maxS.max(quiet.maxS)

  /** Whether the link is busy at a time of a world's flight. Cost grows with the number of stretches before
    * it.
    */
  def isBusy(worldKey: Int, timeNs: Long): Boolean =
    val stretch = Alternating(worldKey)
    while stretch.untilNs <= timeNs do stretch.next()
    stretch.isBusy

  private[skein] def stretches(worldKey: Int): TableStretch = Alternating(worldKey)

  private final class Alternating(worldKey: Int) extends TableStretch:
    private var number = 0
    private var untilS = 0.0
    var isBusy         = uniform(worldKey, number) >= busyLastsS / (busyLastsS + quietLastsS)
    next()

    def table: DelayTable = if isBusy then busy else quiet
    def untilNs: Long     = (untilS * 1e9).ceil.toLong

    def next(): Unit =
      isBusy = !isBusy
      number += 1
      // Exponential stretches have no memory: the first, cut anywhere, lasts as long as any.
      untilS -= StrictMath.log1p(-uniform(worldKey, number)) * (if isBusy then busyLastsS else quietLastsS)

  def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long =
    (if isBusy(worldKey, sentAtNs) then busy else quiet).delayNs(worldKey, line, step, number, sentAtNs)

  private def uniform(worldKey: Int, stretch: Int): Double =
    WorldRandom.uniform(worldKey, stretch * Delays.Lines + Delays.Stretch)
