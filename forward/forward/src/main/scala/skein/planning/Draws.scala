package skein.planning

import skein.simd.WorldRandom

/** Random numbers of candidates. Each is the sum of the four bytes of a hash, scaled to variance 1. It is
  * nearly normal: its fourth moment is 2.7, and its range ends at 3.45 standard deviations.
  */
private[planning] object Draws:
  /** Reciprocal of the standard deviation of the sum of four uniform bytes, √(4 · (256² − 1) / 12). */
  val Scale: Float = (1 / math.sqrt(4 * (256.0 * 256 - 1) / 12)).toFloat

  def normal(key: Int, place: Int): Float =
    val bits = WorldRandom.bits(key, place)
    val sum  = (bits & 0xff) + (bits >>> 8 & 0xff) + (bits >>> 16 & 0xff) + (bits >>> 24)
    (sum - 510) * Scale
