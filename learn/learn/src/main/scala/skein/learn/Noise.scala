package skein.learn

import skein.signal.{NormalQuantile, SplitMix64}
import skein.units.eachBelow

private[learn] object Noise:
  private val Step = 1.0 / (1L << 53)

  /** A normal random number of mean 0 and standard deviation 1. */
  def normal(random: SplitMix64): Double = NormalQuantile(((random.nextLong() >>> 11) + 0.5) * Step)

  def fill(into: Array[Float], random: SplitMix64): Unit =
    eachBelow(into.length): i =>
      into(i) = normal(random).toFloat
