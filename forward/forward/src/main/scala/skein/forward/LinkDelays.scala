package skein.forward

import skein.signal.{Impairment, LatencyProfile, Retransmission}
import skein.simd.WorldRandom
import skein.units.Expect

/** Creates the delays of links from their latency profiles, for forward simulation. */
object LinkDelays:

  /** The longest round trip that forward simulation supports, s. */
  val LongestRoundTripS = 2.0

  /** The delays of a link, if forward simulation supports it.
    *
    * @param timing the loop's, which decides how many packets cross the link, and so how long bursts last
    * @return Left says what was expected and what was given
    */
  def checked(link: LatencyProfile, timing: LoopTiming, vehicles: Int): Either[String, Delays] =
    val reorders = link.impairments.exists(_.isInstanceOf[Impairment.Reordering])
    val base     = link.delays match
      case _ if link.bandwidth.isDefined || reorders => None
      case steady: LatencyProfile.Steady             => Some(of(steady), Seq(steady.roundTrip))
      case alternating: LatencyProfile.Alternating   =>
        Some(of(alternating), Seq(alternating.busy, alternating.quiet))
      case _ => None
    for
      (delays, roundTrips) <- base.toRight(
        s"expected a link without rate, correlation and reordering, which forward simulation does not have, got ${link.name}"
      )
      longestS = roundTrips.map(_.quantile(1).toSeconds).max
      _ <- Expect.that(longestS <= LongestRoundTripS):
        s"expected round trips of at most $LongestRoundTripS s, got ${link.name} with up to $longestS s"
    yield LossyDelays.of(
      delays,
      link.impairments,
      Retransmission.timeout(link).toSeconds,
      packetsPerS(timing, vehicles, link.meanRoundTrip.toSeconds)
    )

  /** Number of packets of a loop per second in each direction: one for each request or its answer, and for
    * each command or its answer. Packets that only acknowledge others are not counted.
    */
  private[forward] def packetsPerS(timing: LoopTiming, vehicles: Int, meanRoundTripS: Double): Double =
    val inSequenceS = vehicles * meanRoundTripS
    timing match
      case LoopTiming.Sequential(periodS, _, _)   => 2 * vehicles / (periodS + inSequenceS)
      case LoopTiming.Futures(periodS, asking, _) =>
        vehicles * (vehicles + 1) * math.min(1 / periodS, asking.window / inSequenceS)
      case _ => 2 * vehicles / timing.periodS

  /** The delays of a link; each is half of a sampled round trip. */
  def of(profile: LatencyProfile.Steady | LatencyProfile.Alternating): TabledDelays = profile match
    case LatencyProfile.Steady(_, roundTrip)                    => DelayTable.of(roundTrip)
    case LatencyProfile.Alternating(_, busy, quiet, lasts, not) =>
      AlternatingDelays(DelayTable.of(busy), DelayTable.of(quiet), lasts.toSeconds, not.toSeconds)

  /** The paper's VPN over a long time, which alternates between `vpn` and `direct`. */
  val vpnMixed: Delays = of(LatencyProfile.vpnMixed)

/** A link that alternates between busy and quiet. The durations are exponentially distributed, and
  * independent in each world. A flight begins at a random moment.
  */
final case class AlternatingDelays(
    busy: DelayTable,
    quiet: DelayTable,
    busyLastsS: Double,
    quietLastsS: Double
) extends TabledDelays:
  require(busyLastsS > 0 && quietLastsS > 0, s"stretches must be positive: $busyLastsS, $quietLastsS s")

  def maxS: Float = busy.maxS.max(quiet.maxS)

  /** Whether the link is busy at a time of a world's flight. Cost is proportional to the number of earlier
    * stretches.
    */
  def isBusy(worldKey: Int, timeNs: Long): Boolean =
    val stretch = Alternating(worldKey)
    while stretch.untilNs <= timeNs do stretch.next()
    stretch.isBusy

  private[skein] def stretches(worldKey: Int): TableStretch = Alternating(worldKey)

  private[skein] def isConstant: Boolean = busy.isConstant || quiet.isConstant

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
      // Exponential durations have no memory: the remainder of the first is distributed like a whole one.
      untilS -= StrictMath.log1p(-uniform(worldKey, number)) * (if isBusy then busyLastsS else quietLastsS)

  def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long =
    (if isBusy(worldKey, sentAtNs) then busy else quiet).delayNs(worldKey, line, step, number, sentAtNs)

  private def uniform(worldKey: Int, stretch: Int): Double =
    WorldRandom.uniform(worldKey, stretch * Delays.Lines + Delays.Stretch)
