package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import skein.forward.DelayTable;
import skein.forward.Delays;
import skein.forward.TabledDelays;
import skein.lanes.policy.LanePolicy;
import skein.simd.WorldRandom;

/**
 * The delays of many worlds' links, as {@link DelayTable} has them, in {@link DelayTable#GrainNs}.
 * Passes draw from them by {@link WorldRandom}'s hash: a look into a table takes as long as a dozen
 * other operations, which go on meanwhile. Where a link's table changes ({@link TabledDelays}), it
 * depends on when a message is sent; such worlds are looked after one by one.
 */
final class LaneDelays {
  private static final int WORLDS = LanePolicy.WORLDS;
  /** Of a hash but for its last step, which does not change the upper bits, these are left out. */
  static final int DROP = DelayTable.Drop();

  private static final LaneVectors ALL = LaneVectors.all();

  /** {@link WorldRandom#key} of each world. */
  private int[] keys;

  /** By {@link Delays#Lines}, and for which start they hold: the keys of further pairs of vehicles. */
  private int[][] pairKeys = new int[1][];

  private int[] madeAt = new int[1];
  private int starts = 0;

  /** The delays of all links, one table after the other. */
  int[] delays = new int[DelayTable.Size()];

  private DelayTable[] tables = new DelayTable[1];
  private int tableCount = 0;

  /** Whether no link's table changes: then where each world's begins. */
  boolean isSteady;

  final int[] tableOf = new int[WORLDS];

  /** By world: the links' tables in turn, where some change. */
  private final TableCourse[] courses = new TableCourse[WORLDS];

  private final int[] sentAt = new int[WORLDS];

  void start(int[] worldKeys, TabledDelays[] links) {
    keys = worldKeys;
    starts++;
    tableCount = 0;
    isSteady = true;
    for (int i = 0; i < WORLDS; i++) {
      if (links[i] instanceof DelayTable table) tableOf[i] = beginOf(table);
      else isSteady = false;
    }
    if (!isSteady)
      for (int i = 0; i < WORLDS; i++) {
        if (courses[i] == null) courses[i] = new TableCourse(this::beginOf);
        courses[i].start(links[i].stretches(worldKeys[i]));
      }
  }

  /** Where a table begins, which becomes the last if it is none of those. */
  private int beginOf(DelayTable table) {
    int size = DelayTable.Size();
    for (int known = tableCount - 1; known >= 0; known--) if (tables[known] == table) return known * size;
    int begin = tableCount * size;
    if (tableCount == tables.length) {
      tables = Arrays.copyOf(tables, 2 * tableCount);
      delays = Arrays.copyOf(delays, 2 * begin);
    }
    if (tables[tableCount] != table) table.copyGrains(delays, begin);
    tables[tableCount++] = table;
    return begin;
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

  /**
   * The delays of a line at places of each world's own.
   *
   * @param begin what times count from, since the episode's begin, in grains
   * @param sentAt when each message is sent; any time where none is
   */
  void draw(LaneVectors vectors, int[] places, int line, long begin, int[] sentAt, int[] into) {
    int[] keys = keysOf(line);
    IntVector there = IntVector.broadcast(INTS, placeOfLine(line));
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector.fromArray(INTS, keys, i)
          .add(IntVector.fromArray(INTS, places, i))
          .add(there)
          .intoArray(into, i);
    }
    look(vectors, begin, sentAt, into);
  }

  /** The delays of a line at one place of all worlds. */
  void draw(int place, int line, long begin, int[] sentAt, int[] into) {
    int[] keys = keysOf(line);
    IntVector there = IntVector.broadcast(INTS, place + placeOfLine(line));
    for (int i = 0; i < WORLDS; i += LANES)
      IntVector.fromArray(INTS, keys, i).add(there).intoArray(into, i);
    look(ALL, begin, sentAt, into);
  }

  /**
   * The delays of an asker's questions to all vehicles, one asked when the one before is answered, and of
   * the answers.
   *
   * @param askedAt when the first is asked
   * @param into the delays of a vehicle's question and of the answer, in turn
   */
  void drawInTurn(LaneVectors vectors, int[] places, int asker, long begin, int[] askedAt, int[][] into) {
    if (!isSteady) System.arraycopy(askedAt, 0, sentAt, 0, WORLDS);
    for (int line = 0; line < into.length; line++) {
      draw(vectors, places, Delays.question(asker, line / 2) + line % 2, begin, sentAt, into[line]);
      if (!isSteady) add(vectors, into[line], sentAt);
    }
  }

  /** Adds spans to times, or to other spans. */
  static void add(LaneVectors vectors, int[] spans, int[] times) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector.fromArray(INTS, times, i).add(IntVector.fromArray(INTS, spans, i)).intoArray(times, i);
    }
  }

  /** Hashes, and looks the delays up. */
  private void look(LaneVectors vectors, long begin, int[] sentAt, int[] values) {
    if (!isSteady) chooseTables(vectors, begin, sentAt);
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

  /** {@link #tableOf} for what is sent at these times. */
  private void chooseTables(LaneVectors vectors, long begin, int[] sentAt) {
    for (int k = 0; k < vectors.count; k++)
      for (int i = vectors.first[k], end = i + LANES; i < end; i++)
        tableOf[i] = courses[i].tableAt(begin + sentAt[i]);
  }
}
