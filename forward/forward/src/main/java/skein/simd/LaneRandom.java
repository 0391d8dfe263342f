package skein.simd;

import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import jdk.incubator.vector.IntVector;

/** {@link WorldRandom} for many worlds side by side, with SIMD. It is a separate class so that {@code
 * WorldRandom} loads no vector classes.
 */
public final class LaneRandom {
  private LaneRandom() {}

  private static final IntVector MULTIPLIER_1 =
      IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_1);
  private static final IntVector MULTIPLIER_2 =
      IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_2);

  /** Computes {@link WorldRandom#bits} at one index of many worlds' sequences.
   *
   * @param count a multiple of the lane count
   */
  public static void bits(int[] keys, int place, int[] into, int count) {
    int offset = place * WorldRandom.STRIDE;
    for (int i = 0; i < count; i += LANES) {
      IntVector x = IntVector.fromArray(INTS, keys, i).add(offset);
      x = x.lanewise(XOR, x.lanewise(LSHR, 16)).mul(MULTIPLIER_1);
      x = x.lanewise(XOR, x.lanewise(LSHR, 15)).mul(MULTIPLIER_2);
      x.lanewise(XOR, x.lanewise(LSHR, 16)).intoArray(into, i);
    }
  }
}
