package skein.link

import java.util.concurrent.atomic.LongAdder
import skein.signal.LatencySampler
import skein.units.*

/** Determines when bytes that enter one direction of one connection come out at its far end. All times count
  * from the link's start. Holds mutable state (earlier bytes delay later ones), one per direction and
  * connection; reads no clock.
  *
  * @param stalls the stalls, in the order of their beginnings
  * @param break the reset or silence that ends this connection
  * @param stallsMet counts the stalls that delayed something
  * @param isInOrder whether bytes come out in the order of entry
  */
private[link] final class Delivery(
    sampler: LatencySampler,
    stalls: Iterator[(from: Span, until: Span)],
    val break: Option[TimedFault],
    stallsMet: LongAdder,
    isInOrder: Boolean = true
):
  private val upcomingStalls = stalls.buffered
  private var lastDue        = Span.Zero
  // Bytes that leave from now on may still fall into these.
  private var met = Vector.empty[(from: Span, until: Span)]

  /** Samples the delay of bytes that enter now.
    *
    * @param now the present time, never smaller than in the previous call
    */
  def delay(now: Span): Span = sampler.oneWay(now)

  /** The time at which bytes that leave at `leave` come out: `delay` later, and never within a stall. None if
    * they are lost.
    */
  def due(leave: Span, delay: Span): Option[Span] =
    met = met.filter(_.until > leave)
    after(if isInOrder then lastDue.max(leave + delay) else leave + delay)

  /** The time at which bytes that are sent again and leave at `leave` come out; later bytes do not delay
    * them.
    */
  def dueAgain(leave: Span, delay: Span): Option[Span] = after(leave + delay)

  private def after(earliest: Span): Option[Span] =
    val due = afterStalls(earliest)
    lastDue = lastDue.max(due)
    Option.unless(lossBegins.exists(_ <= due))(due)

  /** The time at which bytes that enter and leave now come out. */
  def due(now: Span): Option[Span] = due(now, delay(now))

  /** The time at which the connection breaks, with an error on both sides. */
  val breaksAt: Option[Span] = break.map:
    case TimedFault(at, Fault.Silence(lasts)) => at + lasts
    case TimedFault(at, _)                    => at

  private val lossBegins: Option[Span] = break.map(_.at)

  private def afterStalls(due: Span): Span =
    var released = met.foldLeft(due)((at, stall) => if stall.from <= at then at.max(stall.until) else at)
    while upcomingStalls.hasNext && upcomingStalls.head.from <= released do
      val stall = upcomingStalls.next()
      if stall.until > released then
        met = met :+ stall
        released = stall.until
        stallsMet.increment()
    released
