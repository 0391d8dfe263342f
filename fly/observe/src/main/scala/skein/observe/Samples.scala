package skein.observe

import scala.collection.mutable
import skein.measure.Distribution

/** Collects samples of one quantity; keeps the first million. Mutable. */
private[observe] final class Samples:
  private val kept  = mutable.ArrayBuilder.ofDouble()
  private var count = 0L
  private var sum   = 0.0

  def add(sample: Double): Unit =
    if count < Samples.Most then kept += sample
    count += 1
    sum += sample

  def mean: Option[Double] = Option.when(count > 0)(sum / count)

  def added: Long = count

  def distribution: Option[Distribution] = Distribution.of(kept.result())

private object Samples:
  private val Most = 1_000_000L
