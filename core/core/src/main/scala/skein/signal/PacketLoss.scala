package skein.signal

import scala.collection.mutable.ArrayBuffer
import skein.units.*

/** Decides which packets of one direction of a link are lost, all of its connections together. Equal seeds
  * and orders of packets lose equal packets. Any thread.
  *
  * @param linkSeed decides when the link is out: equal for both directions
  * @param seed decides the other losses
  */
final class PacketLoss(profile: LatencyProfile, linkSeed: Long, seed: Long):
  private val outages = profile.impairments.collectFirst:
    case outage: Impairment.Outage => OutageTimes(outage, linkSeed)
  private val bursts = profile.impairments.collectFirst:
    case loss: Impairment.Loss if loss.share > 0 => LossBursts(loss, seed)

  val isAny: Boolean = outages.isDefined || bursts.isDefined

  /** Whether a packet that is sent now is lost.
    *
    * @param at since the link's start
    */
  def loses(at: Span): Boolean = synchronized:
    // A packet of an outage moves the chain, too.
    val inBurst = bursts.exists(_.next())
    outages.exists(_.isOut(at)) || inBurst

  /** How long a packet is sent in vain ([[Retransmission.wait]]). */
  def delay(at: Span, timeout: Span): Span =
    Retransmission.wait(timeout, Int.MaxValue)((_, waited) => loses(at + waited))

private[signal] final class LossBursts(loss: Impairment.Loss, seed: Long):
  private val random = SplitMix64(seed)
  private val leaves = 1 / loss.burst
  private val enters = leaves * loss.share / (1 - loss.share)
  private var isBad  = random.nextDouble() < loss.share

  def next(): Boolean =
    val lost = isBad
    isBad = if isBad then random.nextDouble() >= leaves else random.nextDouble() < enters
    lost

/** The times of [[Impairment.Outage]]s. Requests may go back by as many outages as are kept. */
private[signal] final class OutageTimes(outage: Impairment.Outage, seed: Long):
  private val random  = SplitMix64(seed)
  private val between = (outage.every - outage.lasts).toSeconds
  private val begins  = ArrayBuffer.empty[Span]
  private var until   = Span.Zero

  def isOut(at: Span): Boolean =
    while until <= at do
      begins += until + Span.ofSeconds(random.nextExponential(between))
      until = begins.last + outage.lasts
      if begins.size > 2 * OutageTimes.Kept then begins.remove(0, OutageTimes.Kept)
    val last = begins.lastIndexWhere(_ <= at)
    last >= 0 && at < begins(last) + outage.lasts

private[signal] object OutageTimes:
  val Kept = 1000
