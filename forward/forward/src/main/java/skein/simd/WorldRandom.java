package skein.simd;

import skein.signal.SplitMix64;

/** Random numbers without state: the number at an index of a world's sequence is a hash of the world's key
 * and the index. It depends only on seed, candidate and episode, and not on order, batch or number of
 * threads.
 *
 * <p>The hash is the two-round 32-bit mixer {@code lowbias32} (Chris Wellons, public domain; bias 0.17). It
 * is for simulation, not for secrets.
 */
public final class WorldRandom {
  private WorldRandom() {}

  public static final int MULTIPLIER_1 = 0x7feb352d;
  public static final int MULTIPLIER_2 = 0x846ca68b;

  /** Difference between the hash inputs of successive indices; odd, so that all indices differ. */
  public static final int STRIDE = 0x9e3779b9;

  /** The key of the world in which a candidate flies an episode. */
  public static int key(long seed, long candidate, long episode) {
    long mixed = mix64(mix64(mix64(seed) + candidate) + episode);
    return (int) (mixed >>> 32);
  }

  /** 32 random bits at an index of a world's sequence. */
  public static int bits(int key, int place) {
    int x = key + place * STRIDE;
    x = (x ^ x >>> 16) * MULTIPLIER_1;
    x = (x ^ x >>> 15) * MULTIPLIER_2;
    return x ^ x >>> 16;
  }

  /** A random number in [0, 1), with 24 bits, at an index of a world's sequence. */
  public static double uniform(int key, int place) {
    return (bits(key, place) >>> 8) * 0x1p-24;
  }

  private static long mix64(long value) {
    return SplitMix64.mix(value + SplitMix64.Gamma());
  }
}
