package skein.vehicle

import skein.signal.{NormalQuantile, SplitMix64}

private[vehicle] object GaussMarkov:
  /** The next value of a stationary first-order Gauss–Markov process.
    *
    * @param sigma standard deviation
    * @param lengths time or distance since the last value, in the process's correlation times or lengths
    */
  def next(value: Double, sigma: Double, lengths: Double, random: SplitMix64): Double =
    val keeps = StrictMath.exp(-lengths)
    value * keeps + sigma * math.sqrt(1 - keeps * keeps) * NormalQuantile(random.nextDouble().max(1e-12))
