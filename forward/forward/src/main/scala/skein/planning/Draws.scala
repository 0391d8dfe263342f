package skein.planning

import skein.simd.WorldRandom

/** Random numbers for candidates: the four bytes of a hash added, which is nearly normal (its fourth moment
  * is 2.7 and it ends at 3.45 standard deviations), scaled to variance 1.
  */
private[planning] object Draws:
  /** One over the standard deviation of the sum of four even bytes, √(4 · (256² − 1) / 12). */
  val Scale: Float = (1 / math.sqrt(4 * (256.0 * 256 - 1) / 12)).toFloat

  def normal(key: Int, place: Int): Float =
    val bits = WorldRandom.bits(key, place)
    val sum  = (bits & 0xff) + (bits >>> 8 & 0xff) + (bits >>> 16 & 0xff) + (bits >>> 24)
    (sum - 510) * Scale
