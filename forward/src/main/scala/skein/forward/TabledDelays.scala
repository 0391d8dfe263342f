package skein.forward

/** Delays that come from a [[DelayTable]], always or for a while until another takes its place: what kernels
  * know of links.
  */
trait TabledDelays extends Delays:
  /** The longest, s. */
  def maxS: Float

  /** The first stretch of a world's flight. */
  private[skein] def stretches(worldKey: Int): Stretch

/** A time in which a world's delays come from one table. Mutable: goes on to the next. */
private[skein] trait Stretch:
  def table: DelayTable

  /** What is sent from then on meets the next stretch's delays, ns since the flight's start. */
  def untilNs: Long

  def next(): Unit

private[skein] object Stretch:
  /** One that does not end. */
  final case class Only(table: DelayTable) extends Stretch:
    def untilNs: Long = Long.MaxValue
    def next(): Unit  = ()
