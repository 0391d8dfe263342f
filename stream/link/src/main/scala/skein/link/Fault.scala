package skein.link

import skein.signal.SplitMix64
import skein.units.*

/** A failure of a link. It affects all connections of the link and both directions. */
enum Fault:

  /** Nothing arrives for this long; then everything sent meanwhile arrives, in order. */
  case Stall(lasts: Span)

  /** Every open connection breaks immediately, with an error on both sides. New ones may be opened. */
  case Reset

  /** The other side vanishes without an error: for this long everything sent, or in transit, is lost without
    * a report (half-open connections); attempts to connect get no answer. Then the other side is back and
    * resets open connections. A duration beyond the flight's leaves the connections half-open for good.
    */
  case Silence(lasts: Span)

/** A fault at a time; `at` counts from the link's start. */
final case class TimedFault(at: Span, fault: Fault)

/** The faults of a link over its life: those of a schedule, and random ones.
  *
  * @param schedule scheduled faults, in any order
  * @param stallEvery mean time from a random stall's start to the next's (a Poisson process)
  * @param stallLasts mean length of random stalls, exponentially distributed
  * @param resetEvery mean time between random resets (a Poisson process)
  */
final case class Faults(
    schedule: Seq[TimedFault] = Nil,
    stallEvery: Option[Span] = None,
    stallLasts: Span = Span.ofSeconds(1),
    resetEvery: Option[Span] = None
):
  require(
    (stallEvery ++ resetEvery).forall(_ > Span.Zero) && stallLasts >= Span.Zero,
    s"faults need time between them: $this"
  )

  /** All stalls in the order of their beginnings; infinite if there are random ones. */
  private[link] def stalls(seed: Long): Iterator[(from: Span, until: Span)] =
    val random    = SplitMix64(SplitMix64.seedOf(seed, 1))
    val scheduled = schedule.collect { case TimedFault(at, Fault.Stall(lasts)) =>
      (from = at, until = at + lasts)
    }
    val atRandom = poisson(stallEvery, random).map: at =>
      (from = at, until = at + Span.ofSeconds(random.nextExponential(stallLasts.toSeconds)))
    merge(scheduled.sortBy(_.from).iterator, atRandom)(_.from)

  /** The fault that ends a connection opened at a time: a current silence, or else the first reset or silence
    * after it.
    */
  private[link] def breakOf(opened: Span, seed: Long): Option[TimedFault] =
    val random    = SplitMix64(SplitMix64.seedOf(seed, 2))
    val scheduled = schedule.filter:
      case TimedFault(_, Fault.Stall(_))        => false
      case TimedFault(at, Fault.Reset)          => at > opened
      case TimedFault(at, Fault.Silence(lasts)) => at + lasts > opened
    val atRandom = poisson(resetEvery, random).dropWhile(_ <= opened).take(1).map(TimedFault(_, Fault.Reset))
    (scheduled ++ atRandom).minByOption(_.at)

  private def poisson(every: Option[Span], random: SplitMix64): Iterator[Span] = every match
    case None       => Iterator.empty
    case Some(mean) =>
      Iterator.iterate(Span.Zero)(_ + Span.ofSeconds(random.nextExponential(mean.toSeconds))).drop(1)

  private def merge[A](first: Iterator[A], second: Iterator[A])(at: A => Span): Iterator[A] =
    val (a, b) = (first.buffered, second.buffered)
    Iterator.continually(()).takeWhile(_ => a.hasNext || b.hasNext).map: _ =>
      if !b.hasNext || a.hasNext && at(a.head) <= at(b.head) then a.next() else b.next()

object Faults:
  val none: Faults = Faults()
