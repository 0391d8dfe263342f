package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import jdk.incubator.vector.IntVector;
import skein.lanes.policy.LanePolicy;

/** The SIMD vectors of a block that a pass processes: those with an event in at least one of their worlds.
 * Mutable.
 */
public final class LaneVectors {
  private static final int WORLDS = LanePolicy.WORLDS;

  public final int[] first = new int[WORLDS / LANES];

  public int count;

  public static LaneVectors all() {
    LaneVectors all = new LaneVectors();
    all.takeAll();
    return all;
  }

  void takeAll() {
    count = 0;
    for (int i = 0; i < WORLDS; i += LANES) first[count++] = i;
  }

  /** Selects the vectors in which at least one world has a time below {@code noneAt}.
   *
   * @param noneAt the number that means "no time", greater than all times
   */
  public void take(int[] times, int noneAt) {
    IntVector none = IntVector.broadcast(INTS, noneAt);
    count = 0;
    for (int i = 0; i < WORLDS; i += LANES)
      if (IntVector.fromArray(INTS, times, i).compare(LT, none).anyTrue()) first[count++] = i;
  }
}
