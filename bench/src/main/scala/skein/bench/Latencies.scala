package skein.bench

import java.util.concurrent.atomic.AtomicInteger

/** Latencies in ns, recorded from any thread; the first 2^23 are kept for the quantiles. */
private final class Latencies:
  private val nanos = new Array[Long](1 << 23)
  private val added = AtomicInteger()

  def count: Int = added.get

  def add(latency: Long): Unit =
    val i = added.getAndIncrement()
    if i < nanos.length then nanos(i) = latency

  def quantile(p: Double): Long =
    val sorted = java.util.Arrays.copyOf(nanos, math.min(count, nanos.length)).sorted
    sorted(math.min((sorted.length * p).toInt, sorted.length - 1))
