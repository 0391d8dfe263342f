package skein.forward

import skein.signal.LatencyDistribution
import skein.simd.WorldRandom
import skein.units.*

/** One-way delays of a link by 1024 equally likely values, for kernels: a random number's upper ten bits
  * choose one. Successive messages are independent.
  *
  * @param delaysS ascending, s: half of the round trip's quantile in the middle of each 1024th
  */
final class DelayTable private (val delaysS: Array[Float]) extends TabledDelays:
  private val delaysNs =
    delaysS.map(s => math.round(Span.ofSeconds(s).toNanos.toDouble / DelayTable.GrainNs) * DelayTable.GrainNs)

  def maxS: Float = delaysS.last

  private[skein] def stretches(worldKey: Int): TableStretch = TableStretch.Only(this)

  /** Puts all delays, in [[DelayTable.GrainNs]], into an array from a place on; all must be less than eight
    * seconds.
    */
  private[skein] def copyGrains(into: Array[Int], at: Int): Unit =
    for i <- delaysNs.indices do into(at + i) = Math.toIntExact(delaysNs(i) / DelayTable.GrainNs)

  def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long =
    delaysNs(WorldRandom.bits(
      Delays.keyOf(worldKey, line),
      step * Delays.Lines + line % Delays.Lines
    ) >>> DelayTable.Drop)

object DelayTable:
  val Size = 1024

  /** Delays are whole multiples of this, so that kernels count time exactly in 32 bits. */
  private[skein] val GrainNs: Int = 4

  /** Bits of a random number that are not used. */
  val Drop: Int = 32 - Integer.numberOfTrailingZeros(Size)

  def of(roundTrip: LatencyDistribution): DelayTable =
    DelayTable(Array.tabulate(Size)(i => (roundTrip.quantile((i + 0.5) / Size).toSeconds / 2).toFloat))

  val none: DelayTable   = of(LatencyDistribution.Constant(Span.Zero))
  val direct: DelayTable = of(LatencyDistribution.Direct)
  val vpn: DelayTable    = of(LatencyDistribution.Vpn)

/** Delays that come from a [[DelayTable]], always or for a while until another takes its place: what kernels
  * know of links.
  */
trait TabledDelays extends Delays:
  /** The longest, s. */
  def maxS: Float

  /** The first stretch of a world's flight. */
  private[skein] def stretches(worldKey: Int): TableStretch

/** A time in which a world's delays come from one table. Mutable: goes on to the next. */
private[skein] trait TableStretch:
  def table: DelayTable

  /** What is sent from then on meets the next stretch's delays, ns since the flight's start. */
  def untilNs: Long

  def next(): Unit

private[skein] object TableStretch:
  /** One that does not end. */
  final case class Only(table: DelayTable) extends TableStretch:
    def untilNs: Long = Long.MaxValue
    def next(): Unit  = ()
