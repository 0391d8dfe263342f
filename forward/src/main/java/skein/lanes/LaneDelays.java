package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import skein.forward.DelayTable;
import skein.forward.Delays;
import skein.simd.WorldRandom;

/**
 * The delays of many worlds' links, as {@link DelayTable} has them, in {@link DelayTable#GrainNs}.
 * Passes draw from them by {@link WorldRandom}'s hash: a look into a table takes as long as a dozen
 * other operations, which go on meanwhile.
 */
final class LaneDelays {
  private static final int WORLDS = LanePolicy.WORLDS;
  /** Of a hash but for its last step, which does not change the upper bits, these are left out. */
  static final int DROP = DelayTable.Drop();

  /** {@link WorldRandom#key} of each world. */
  private int[] keys;

  /** By {@link Delays#Lines}, and for which start they hold: the keys of further pairs of vehicles. */
  private int[][] pairKeys = new int[1][];

  private int[] madeAt = new int[1];
  private int starts = 0;

  /** The delays of all links, one table after the other; and where each world's begins. */
  int[] delays = new int[DelayTable.Size()];

  final int[] tableOf = new int[WORLDS];
  private final DelayTable[] tables = new DelayTable[WORLDS];
  private int tableCount = 0;

  void start(int[] worldKeys, DelayTable[] links) {
    keys = worldKeys;
    starts++;
    int count = 0;
    for (int i = 0; i < WORLDS; i++) {
      int table = i > 0 && links[i] == links[i - 1] ? tableOf[i - 1] / DelayTable.Size() : count;
      if (table == count) {
        if (count >= tableCount || tables[count] != links[i]) {
          int end = (count + 1) * DelayTable.Size();
          if (delays.length < end) delays = Arrays.copyOf(delays, 2 * end);
          links[i].copyGrains(delays, count * DelayTable.Size());
          tables[count] = links[i];
        }
        count++;
      }
      tableOf[i] = table * DelayTable.Size();
    }
    tableCount = Math.max(tableCount, count);
  }

  /** By world, the key of the sequence that a line's delays come from, as {@link Delays#keyOf}. */
  int[] keysOf(int line) {
    int pair = line / Delays.Lines();
    if (pair == 0) return keys;
    if (pair >= pairKeys.length) {
      pairKeys = Arrays.copyOf(pairKeys, 2 * pair);
      madeAt = Arrays.copyOf(madeAt, 2 * pair);
    }
    if (madeAt[pair] != starts) {
      if (pairKeys[pair] == null) pairKeys[pair] = new int[WORLDS];
      for (int i = 0; i < WORLDS; i++) pairKeys[pair][i] = Delays.keyOf(keys[i], line);
      madeAt[pair] = starts;
    }
    return pairKeys[pair];
  }

  /** Where a line's random numbers are in those of a step. */
  static int placeOfLine(int line) {
    return line % Delays.Lines() * WorldRandom.STRIDE;
  }

  /** Where the random numbers of a step begin. */
  static int placeOf(int step) {
    return step * Delays.Lines() * WorldRandom.STRIDE;
  }

  private static final LaneVectors ALL = LaneVectors.all();

  /** The delays of a line at places of each world's own. */
  void draw(LaneVectors vectors, int[] places, int line, int[] into) {
    int[] keys = keysOf(line);
    IntVector there = IntVector.broadcast(INTS, placeOfLine(line));
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector.fromArray(INTS, keys, i)
          .add(IntVector.fromArray(INTS, places, i))
          .add(there)
          .intoArray(into, i);
    }
    look(vectors, into);
  }

  /** The delays of a line at one place of all worlds. */
  void draw(int place, int line, int[] into) {
    int[] keys = keysOf(line);
    IntVector there = IntVector.broadcast(INTS, place + placeOfLine(line));
    for (int i = 0; i < WORLDS; i += LANES)
      IntVector.fromArray(INTS, keys, i).add(there).intoArray(into, i);
    look(ALL, into);
  }

  /** Hashes, and looks the delays up. */
  private void look(LaneVectors vectors, int[] values) {
    IntVector multiplier1 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_1),
        multiplier2 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_2);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector a = IntVector.fromArray(INTS, values, i);
      a = a.lanewise(XOR, a.lanewise(LSHR, 16)).mul(multiplier1);
      a = a.lanewise(XOR, a.lanewise(LSHR, 15)).mul(multiplier2);
      a.lanewise(LSHR, DROP).add(IntVector.fromArray(INTS, tableOf, i)).intoArray(values, i);
    }
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector.fromArray(INTS, delays, 0, values, i).intoArray(values, i);
    }
  }
}
