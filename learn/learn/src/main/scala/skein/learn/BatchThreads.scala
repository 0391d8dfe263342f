package skein.learn

import java.util.concurrent.ForkJoinPool
import java.util.stream.IntStream
import skein.units.{eachBelow, eachFrom}

/** Threads that share a batch's rows, in parts of a fixed number of rows, so that sums over parts have equal
  * bits on any number of threads. A batch takes less time than starting threads, so they wait here for the
  * next one.
  */
final class BatchThreads(threads: Int) extends AutoCloseable:
  private val pool = Option.when(threads > 1)(ForkJoinPool(threads))

  /** Blocks until all parts are done.
    *
    * @param work takes a part's number, its first row and the row after its last
    */
  def share(rows: Int)(work: (Int, Int, Int) => Unit): Unit =
    val parts          = BatchThreads.parts(rows)
    def one(part: Int) =
      work(part, part * BatchThreads.Rows, (part * BatchThreads.Rows + BatchThreads.Rows).min(rows))
    pool match
      case Some(pool) if parts > 1 =>
        val all: Runnable = () => IntStream.range(0, parts).parallel().forEach(one)
        pool.submit(all).get(): Unit
      case _ => (0 until parts).foreach(one)

  def close(): Unit = pool.foreach(_.shutdownNow())

object BatchThreads:
  /** The fixed number of rows in a part of a batch. */
  private val Rows = 64

  def parts(rows: Int): Int = (rows + Rows - 1) / Rows

/** A network's gradient, summed part by part. */
private[learn] final class Gradient(size: Int, rows: Int):
  private val parts = Array.fill(BatchThreads.parts(rows))(Array.ofDim[Float](size))

  def of(part: Int): Array[Float] = parts(part)

  def clear(): Unit = parts.foreach(java.util.Arrays.fill(_, 0f))

  /** Adds all parts in order and returns their sum. */
  def sum(): Array[Float] =
    val total = parts(0)
    eachFrom(1, parts.length): part =>
      val more = parts(part)
      eachBelow(size): i =>
        total(i) = total(i) + more(i)
    total
