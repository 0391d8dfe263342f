package skein.link

import java.util.concurrent.atomic.LongAdder
import skein.signal.LatencySampler
import skein.units.*

/** Decides when what enters one direction of one connection comes out at its far end. All times count from the link's
  * start. Holds mutable state (what entered before delays what enters after), one per direction and connection; reads
  * no clock.
  *
  * @param stalls
  *   in the order of their beginnings
  * @param break
  *   the reset or silence that ends this connection
  * @param stallsMet
  *   counts the stalls that held something up
  */
private[link] final class Delivery(
    sampler: LatencySampler,
    stalls: Iterator[(from: Span, until: Span)],
    val break: Option[TimedFault],
    bytesPerSecond: Option[Double],
    stallsMet: LongAdder
):
  private val upcomingStalls = stalls.buffered
  private var lineFree       = Span.Zero
  private var lastDue        = Span.Zero

  /** When these bytes come out: in the order in which they entered, a sampled delay after the line has sent them, and
    * never within a stall. None if they are lost.
    *
    * @param now
    *   never smaller than at the call before
    */
  def due(now: Span, bytes: Int): Option[Span] =
    lineFree = lineFree.max(now) + bytesPerSecond.fold(Span.Zero)(rate => Span.ofSeconds(bytes / rate))
    lastDue = afterStalls(lastDue.max(lineFree + sampler.oneWay(now)))
    Option.unless(lossBegins.exists(_ <= lastDue))(lastDue)

  /** When the connection breaks and both sides are told. */
  val breaksAt: Option[Span] = break.map:
    case TimedFault(at, Fault.Silence(lasts)) => at + lasts
    case TimedFault(at, _)                    => at

  private val lossBegins: Option[Span] = break.map(_.at)

  private def afterStalls(due: Span): Span =
    var released = due
    while upcomingStalls.hasNext && upcomingStalls.head.from <= released do
      val end = upcomingStalls.next().until
      if end > released then
        released = end
        stallsMet.increment()
    released
