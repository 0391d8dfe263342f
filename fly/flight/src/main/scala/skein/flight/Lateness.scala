package skein.flight

import skein.units.*
import skein.units.Decimals.fixed

/** The lateness of the control threads, measured by a timer: on a machine that is too busy they wait for a
  * processor, and a flight then shows the machine and not its loop.
  *
  * @param ticks number of ticks so far
  * @param late number of ticks late by more than [[Lateness.Allowed]]
  * @param most the largest lateness
  */
private[skein] final case class Lateness(ticks: Int = 0, late: Int = 0, most: Span = Span.Zero):
  import Lateness.*

  /** Adds a tick.
    *
    * @param by time from the moment at which it was due until it ran
    */
  def ticked(by: Span): Lateness =
    Lateness(ticks + 1, if by > Allowed then late + 1 else late, most.max(by))

  /** Why the flight is not comparable: too many ticks were late, or one was very late. In a line for a
    * person.
    */
  def starved: Option[String] =
    Option.when(ticks >= LeastTicks && (late > ticks * MostLate || most > MostOnce)):
      s"the machine was too busy: ${(100.0 * late / ticks).fixed(0)} % of $ticks ticks came more than " +
        s"${Allowed.toMillis.fixed(0)} ms late, one ${most.toMillis.fixed(0)} ms"

private[skein] object Lateness:
  /** Why a flight whose simulator skipped time is not comparable. */
  def skipped(time: Span): Option[String] = Option.when(time > Span.Zero):
    s"the machine was too busy: the simulator skipped ${time.toMillis.round} ms"

  /** Tolerance of a tick's lateness: two ticks of the scheduler. A vehicle at 10 m/s moves 0.2 m in it. */
  val Allowed: Span = Span.ofMillis(20)

  /** Largest share of late ticks in a comparable flight. */
  val MostLate = 0.05

  /** Largest lateness of one tick in a comparable flight. A vehicle at 10 m/s moves 5 m in it, which it takes
    * seconds to make good.
    */
  val MostOnce: Span = Span.ofMillis(500)

  /** With fewer ticks than these, a flight counts as comparable. */
  private val LeastTicks = 20
