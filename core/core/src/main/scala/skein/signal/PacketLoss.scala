package skein.signal

import scala.collection.mutable.ArrayBuffer
import skein.units.*

/** Decides which packets are lost in one direction of a link, over all of its connections. Equal seeds and
  * orders of packets lose equal packets. May be called by any thread.
  *
  * @param linkSeed determines the outages; equal for both directions
  * @param seed determines the other losses
  */
final class PacketLoss(profile: LatencyProfile, linkSeed: Long, seed: Long):
  private val outages = profile.impairments.collectFirst:
    case outage: Impairment.Outage => OutageTimes(outage, linkSeed)
  private val bursts = profile.impairments.collectFirst:
    case loss: Impairment.Loss if loss.share > 0 => LossBursts(loss, seed)

  val isAny: Boolean = outages.isDefined || bursts.isDefined

  /** Whether a packet that is sent now is lost.
    *
    * @param at time since the link's start
    */
  def loses(at: Span): Boolean = synchronized:
    // A packet of an outage moves the chain, too.
    val inBurst = bursts.exists(_.next())
    outages.exists(_.isOut(at)) || inBurst

  /** Time from the first try to send a packet until the successful one ([[Retransmission.wait]]). */
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

/** The times of [[Impairment.Outage]]s. A call may go back in time by [[OutageTimes.Kept]] outages. */
private[skein] final class OutageTimes(outage: Impairment.Outage, seed: Long):
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

private[skein] object OutageTimes:
  val Kept = 1000
