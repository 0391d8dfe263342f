package skein.search

import java.nio.ByteBuffer
import scala.collection.immutable.ArraySeq
import skein.optimise.RunningStats

/** Statistics as blocks' answers have them, big-endian: count, mean and sum of squares, 4, 8 and 8 bytes each. */
private[skein] object StatsBytes:
  val Each = 20

  def write(all: Seq[RunningStats]): ArraySeq[Byte] =
    val out = ByteBuffer.allocate(Each * all.size)
    for stats <- all do out.putInt(stats.count).putDouble(stats.mean).putDouble(stats.squares)
    ArraySeq.unsafeWrapArray(out.array)

  def read(in: ByteBuffer): RunningStats = RunningStats(in.getInt, in.getDouble, in.getDouble)
