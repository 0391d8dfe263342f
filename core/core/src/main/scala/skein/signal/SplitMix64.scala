package skein.signal

/** A small seeded random number generator with its own state. The sequence of a seed is equal on all machines
  * and in all versions; replays of recordings rely on that. Not for secrets, and not thread-safe.
  *
  * Source: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014, with the
  * constants of Vigna's public-domain `splitmix64.c`; `SplitMix64Suite` compares it with its published first
  * outputs.
  */
final class SplitMix64(seed: Long):
  import SplitMix64.*

  private var state = seed

  /** Uniformly distributed over all 2^64^ values. */
  def nextLong(): Long =
    state += Gamma
    mix(state)

  /** Uniformly distributed in [0, 1), in steps of 2^−53^. */
  def nextDouble(): Double = (nextLong() >>> 11) * Step

  /** Uniformly distributed in 0 until `bound`, which must be positive. */
  def nextInt(bound: Int): Int = (nextDouble() * bound).toInt

  /** Exponentially distributed with this mean: the time to the next event of a Poisson process. */
  def nextExponential(mean: Double): Double = -mean * StrictMath.log1p(-nextDouble())

object SplitMix64:
  private val Step = 1.0 / (1L << 53)

  /** The difference between successive states of a sequence. */
  private[skein] final val Gamma = 0x9e3779b97f4a7c15L

  /** The output for a state (Steele, Lea and Flood, 2014). */
  private[skein] def mix(z0: Long): Long =
    val z1 = (z0 ^ (z0 >>> 30)) * 0xbf58476d1ce4e5b9L
    val z2 = (z1 ^ (z1 >>> 27)) * 0x94d049bb133111ebL
    z2 ^ (z2 >>> 31)

  /** The seed of sequence number `index` of the many independent sequences that belong to one seed. */
  def seedOf(seed: Long, index: Long): Long = mix(mix(seed + Gamma) ^ mix(index * Gamma + 1))
