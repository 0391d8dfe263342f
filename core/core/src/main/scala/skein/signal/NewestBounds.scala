package skein.signal

import java.util.Arrays
import skein.units.*

/** Bounds of the newest readings, at most [[NewestBounds.Memory]], in sorted arrays. A further reading costs
  * a copy of each array. (Sorting anew at every reading took a sixteenth of a virtual flight.)
  *
  * @param bounds bounds of each reading, the newest last
  * @param to negated lower bounds, ns, sorted
  * @param from upper bounds, ns, sorted
  */
private final class NewestBounds private (
    bounds: Vector[NewestBounds.Bounds],
    to: Array[Long],
    from: Array[Long]
):
  import NewestBounds.*

  def updated(one: Bounds): NewestBounds =
    if bounds.size < Memory then
      NewestBounds(bounds :+ one, inserted(to, toOf(one)), inserted(from, fromOf(one)))
    else
      val oldest = bounds.head
      NewestBounds(
        bounds.tail :+ one,
        replaced(to, toOf(oldest), toOf(one)),
        replaced(from, fromOf(oldest), fromOf(one))
      )

  /** Lower quartile of the delays towards the simulator, plus the clocks' offset, ns. */
  def quartileTo: Long = quartile(to)

  /** Lower quartile of the delays from the simulator, minus the clocks' offset, ns. */
  def quartileFrom: Long = quartile(from)

  override def equals(other: Any): Boolean = other match
    case other: NewestBounds => other.newest == newest
    case _                   => false
  override def hashCode: Int = bounds.hashCode

  private def newest = bounds

private object NewestBounds:
  /** Bounds of the clocks' offset, controller minus simulator, from one reading. */
  final case class Bounds(lower: Span, upper: Span)

  /** Number of readings from which the estimate between the bounds is made. More readings estimate a quartile
    * better; fewer follow drifting clocks sooner. With 20 readings per second, the error for clocks that
    * differ by 50 parts per million is below 0.5 ms.
    */
  val Memory = 384

  def of(one: Bounds): NewestBounds = NewestBounds(Vector(one), Array(toOf(one)), Array(fromOf(one)))

  private def toOf(bounds: Bounds)   = -bounds.lower.toNanos
  private def fromOf(bounds: Bounds) = bounds.upper.toNanos

  private def quartile(sorted: Array[Long]) = sorted((sorted.length - 1) / 4)

  /** The index of a value, or the index at which it would be inserted. */
  private def place(sorted: Array[Long], number: Long): Int =
    val found = Arrays.binarySearch(sorted, number)
    if found < 0 then -found - 1 else found

  private def inserted(sorted: Array[Long], one: Long): Array[Long] =
    val at   = place(sorted, one)
    val next = Arrays.copyOf(sorted, sorted.length + 1)
    System.arraycopy(sorted, at, next, at + 1, sorted.length - at)
    next(at) = one
    next

  /** The sorted values with `one` in place of `gone`, which is among them. */
  private def replaced(sorted: Array[Long], gone: Long, one: Long): Array[Long] =
    if one == gone then sorted
    else
      val (out, at) = (place(sorted, gone), place(sorted, one))
      val next      = sorted.clone()
      if out < at then
        System.arraycopy(sorted, out + 1, next, out, at - 1 - out)
        next(at - 1) = one
      else
        System.arraycopy(sorted, at, next, at + 1, out - at)
        next(at) = one
      next
