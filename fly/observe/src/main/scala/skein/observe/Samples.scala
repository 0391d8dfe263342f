package skein.observe

import skein.measure.Distribution

/** Collects samples of one quantity; keeps the first million. Mutable. */
private[observe] final class Samples:
  private var kept  = new Array[Double](16)
  private var count = 0L
  private var sum   = 0.0

  def add(sample: Double): Unit =
    if count < Samples.Most then
      if count == kept.length then kept = kept.padTo(2 * kept.length, 0.0)
      kept(count.toInt) = sample
    count += 1
    sum += sample

  def mean: Option[Double] = Option.when(count > 0)(sum / count)

  def added: Long = count

  /** The distribution of the samples so far; more may follow. */
  def distribution: Option[Distribution] = Distribution.of(kept.take(count.min(Samples.Most).toInt))

private object Samples:
  private val Most = 1_000_000L
