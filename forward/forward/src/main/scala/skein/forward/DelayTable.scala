package skein.forward

import skein.signal.LatencyDistribution
import skein.simd.WorldRandom
import skein.units.*

/** One-way delays of a link as 1024 equally likely values, for kernels: the upper ten bits of a random number
  * choose one. Delays of successive messages are independent.
  *
  * @param delaysS ascending, s: half of the round trip's quantile at the middle of each 1024th
  */
final class DelayTable private (val delaysS: Array[Float]) extends TabledDelays:
  private val delaysNs =
    delaysS.map(s => math.round(Span.ofSeconds(s).toNanos.toDouble / DelayTable.GrainNs) * DelayTable.GrainNs)

  def maxS: Float = delaysS.last

  private[skein] def stretches(worldKey: Int): TableStretch = TableStretch.Only(this)

  private[skein] def isConstant: Boolean = delaysNs.head == delaysNs.last

  /** Copies all delays into an array, from index `at` on, in units of [[DelayTable.GrainNs]]. All delays must
    * be less than eight seconds.
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

  /** Unit of delays, ns. Delays are whole multiples of it, so that kernels compute times exactly in 32 bits.
    */
  private[skein] val GrainNs: Int = 4

  /** Number of low bits of a random number that do not choose the delay. */
  val Drop: Int = 32 - Integer.numberOfTrailingZeros(Size)

  def of(roundTrip: LatencyDistribution): DelayTable =
    DelayTable(Array.tabulate(Size)(i => (roundTrip.quantile((i + 0.5) / Size).toSeconds / 2).toFloat))

  val none: DelayTable   = of(LatencyDistribution.Constant(Span.Zero))
  val direct: DelayTable = of(LatencyDistribution.Direct)
  val vpn: DelayTable    = of(LatencyDistribution.Vpn)

/** Delays from a [[DelayTable]], which may be replaced by another table from time to time. Kernels support
  * only such links.
  */
trait TabledDelays extends Delays:
  /** The longest one-way delay of the link, s. */
  def maxS: Float

  private[skein] def stretches(worldKey: Int): TableStretch

  /** Whether all delays are equal, at least for a time, apart from losses. */
  private[skein] def isConstant: Boolean

/** A stretch of time in which a world's delays come from one table. Mutable: `next` moves to the following
  * stretch.
  */
private[skein] trait TableStretch:
  def table: DelayTable

  /** End of the stretch, exclusive, ns since the flight's start. It applies to the times of sending. */
  def untilNs: Long

  def next(): Unit

private[skein] object TableStretch:
  final case class Only(table: DelayTable) extends TableStretch:
    def untilNs: Long = Long.MaxValue
    def next(): Unit  = ()
