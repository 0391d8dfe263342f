package skein.rollout;

import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.rollout.LaneMath.INTS;
import static skein.rollout.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;

/**
 * The delays of many worlds' links, as {@link DelayTable} and {@link WorldRandom} give them, in
 * {@link DelayTable#GrainNs}.
 */
final class LaneDelays {
  private static final int WORLDS = LanePolicy.WORLDS;
  private static final int DROP = DelayTable.Drop();
  private static final IntVector MULTIPLIER_1 =
          IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_1),
      MULTIPLIER_2 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_2);

  private int[] keys;

  /** The delays of all links, one table after the other; and where each world's begins. */
  private int[] delays = new int[DelayTable.Size()];

  private final int[] tableOf = new int[WORLDS];
  private final DelayTable[] tables = new DelayTable[WORLDS];
  private int tableCount = 0;

  private final int[] drawn = new int[4 * WORLDS];

  /** Longest delay of any link, s. */
  float maxS;

  void start(int[] worldKeys, DelayTable[] links) {
    keys = worldKeys;
    int count = 0;
    maxS = 0;
    for (int i = 0; i < WORLDS; i++) {
      int table = i > 0 && links[i] == links[i - 1] ? tableOf[i - 1] / DelayTable.Size() : count;
      if (table == count) {
        if (count >= tableCount || tables[count] != links[i]) {
          int end = (count + 1) * DelayTable.Size();
          if (delays.length < end) delays = Arrays.copyOf(delays, 2 * end);
          links[i].copyGrains(delays, count * DelayTable.Size());
          tables[count] = links[i];
        }
        maxS = Math.max(maxS, links[i].maxS());
        count++;
      }
      tableOf[i] = table * DelayTable.Size();
    }
    tableCount = Math.max(tableCount, count);
  }

  /** Where the random numbers of a step begin. */
  static int placeOf(int step) {
    return step * Rollout.Places() * WorldRandom.STRIDE;
  }

  /**
   * Delays to and from both vehicles of each world, on four lines from this one on.
   *
   * @param places of the steps that the messages belong to, by vehicle
   */
  void draw(int[][] places, int line, int[][] to, int[][] from) {
    draw(places[0], line, to[0], from[0]);
    draw(places[1], line + 2, to[1], from[1]);
  }

  private void draw(int[] places, int line, int[] to, int[] from) {
    IntVector one = IntVector.broadcast(INTS, line * WorldRandom.STRIDE),
        two = IntVector.broadcast(INTS, (line + 1) * WorldRandom.STRIDE);
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector key = IntVector.fromArray(INTS, keys, i).add(IntVector.fromArray(INTS, places, i));
      IntVector table = IntVector.fromArray(INTS, tableOf, i);
      IntVector x = key.add(one), y = key.add(two);
      x = x.lanewise(XOR, x.lanewise(LSHR, 16)).mul(MULTIPLIER_1);
      y = y.lanewise(XOR, y.lanewise(LSHR, 16)).mul(MULTIPLIER_1);
      x = x.lanewise(XOR, x.lanewise(LSHR, 15)).mul(MULTIPLIER_2);
      y = y.lanewise(XOR, y.lanewise(LSHR, 15)).mul(MULTIPLIER_2);
      // The last step of the hash changes none of the upper half.
      x.lanewise(LSHR, DROP).add(table).intoArray(drawn, 2 * i);
      y.lanewise(LSHR, DROP).add(table).intoArray(drawn, 2 * i + LANES);
      IntVector.fromArray(INTS, delays, 0, drawn, 2 * i).intoArray(to, i);
      IntVector.fromArray(INTS, delays, 0, drawn, 2 * i + LANES).intoArray(from, i);
    }
  }
}
