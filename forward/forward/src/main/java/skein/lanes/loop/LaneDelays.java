package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.ASHR;
import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.NE;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.DelayTable;
import skein.forward.Delays;
import skein.forward.LossTimes;
import skein.forward.LossyDelays;
import skein.forward.TabledDelays;
import skein.lanes.policy.LanePolicy;
import skein.simd.WorldRandom;

/** Draws the delays of many worlds' links from each link's {@link DelayTable}, in units of {@link
 * DelayTable#GrainNs}, by {@link WorldRandom}'s hash: a table look-up takes as long as a dozen other
 * operations, which overlap with it. If a link's table changes over time ({@link TabledDelays}), the time of
 * sending decides which table applies; such worlds are processed one by one. So are messages that may be lost
 * in bursts or outages ({@link LossyDelays}).
 */
final class LaneDelays {
  private static final int WORLDS = LanePolicy.WORLDS;
  /** Number of low bits dropped from a hash. The hash omits its last step, which does not change the upper
   * bits.
   */
  static final int DROP = DelayTable.Drop();

  private static final int LOW_BITS = (1 << DROP) - 1;

  private static final LaneVectors ALL = LaneVectors.all();

  private int[] keys;

  /** Keys of the links to further pairs of vehicles, by line divided by {@link Delays#Lines}; and the count
   * of starts for which each entry is valid.
   */
  private int[][] pairKeys = new int[1][];

  private int[] madeAt = new int[1];
  private int starts = 0;

  /** The delay tables of all links, concatenated. */
  int[] delays = new int[DelayTable.Size()];

  private DelayTable[] tables = new DelayTable[1];
  private int tableCount = 0;

  /** Whether delays are independent of the time of sending: no link's table changes, and no link loses
   * packets.
   */
  boolean isSteady;

  /** Whether some link's delays are equal for a time, so that many messages arrive in one moment. */
  boolean isConstant;

  /** Whether some link's table changes, whether some link loses packets, and whether losses depend on the
   * time.
   */
  private boolean changes, loses, losesByTime;

  /** The losses of each world's link, null without losses; and the times during which that link loses
   * everything.
   */
  private final LossyDelays[] lossy = new LossyDelays[WORLDS];

  private final LossTimes[] lossTimes = new LossTimes[WORLDS];

  /** A message of a world may be lost if the low bits of its random number are below this. */
  private final int[] lossThreshold = new int[WORLDS];

  /** The first time-out of a lost message, in grains, and how often it is sent again at most. */
  private final int[] timeout = new int[WORLDS], mostTries = new int[WORLDS];

  /** The loss-free time around the last message, by {@link #calmOf} and world: its begin and end, since the
   * flight's start, in units of 2^{@link #COARSE} grains.
   */
  private final int[][] calmFrom = new int[4][WORLDS], calmUntil = new int[4][WORLDS];

  /** Number of low bits dropped from times that are compared with a loss-free time, so that hours fit into an
   * int.
   */
  private static final int COARSE = 12;

  private final int[] bits = new int[WORLDS];


  final int[] tableOf = new int[WORLDS];

  /** The sequence of tables of each world's link; only where some link's table changes. */
  private final TableCourse[] courses = new TableCourse[WORLDS];

  private final int[] sentAt = new int[WORLDS];

  void start(int[] worldKeys, TabledDelays[] links) {
    keys = worldKeys;
    starts++;
    tableCount = 0;
    changes = loses = losesByTime = isConstant = false;
    for (int i = 0; i < WORLDS; i++) {
      lossy[i] = links[i] instanceof LossyDelays losing ? losing : null;
      if (lossy[i] != null) startLosses(i, worldKeys[i]);
      else lossThreshold[i] = 0;
      TabledDelays base = baseOf(links[i]);
      if (base instanceof DelayTable table) tableOf[i] = beginOf(table);
      else changes = true;
      isConstant |= base.isConstant();
    }
    isSteady = !changes && !loses;
    if (changes)
      for (int i = 0; i < WORLDS; i++) {
        if (courses[i] == null) courses[i] = new TableCourse(this::beginOf);
        courses[i].start(baseOf(links[i]).stretches(worldKeys[i]));
      }
  }

  private void startLosses(int world, int worldKey) {
    loses = true;
    lossThreshold[world] = lossy[world].lossThreshold();
    timeout[world] = (int) (lossy[world].timeoutNs() / DelayTable.GrainNs());
    mostTries[world] = lossy[world].mostTries();
    losesByTime |= lossy[world].isTimed();
    lossTimes[world] = lossy[world].times(worldKey);
    for (int calm = 0; calm < 4; calm++) {
      calmFrom[calm][world] = 0;
      calmUntil[calm][world] = lossy[world].isTimed() ? 0 : Integer.MAX_VALUE;
    }
  }

  private static TabledDelays baseOf(TabledDelays link) {
    return link instanceof LossyDelays losing ? losing.base() : link;
  }

  /** Offset of a table in {@link #delays}; adds a new table at the end. */
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

  /** The key of the random sequence of a line's delays in each world, as {@link Delays#keyOf} computes it. */
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

  /** Offset of a line's random numbers within those of a step. */
  static int placeOfLine(int line) {
    return line % Delays.Lines() * WorldRandom.STRIDE;
  }

  /** Offset of the random numbers of a step. */
  static int placeOf(int step) {
    return step * Delays.Lines() * WorldRandom.STRIDE;
  }

  /** Draws a line's delays in each world, at the world's index in the random sequence.
   *
   * @param begin origin of the times, since the episode's start, in grains
   * @param sentAt time of sending, in grains from {@code begin}; arbitrary in worlds without a message
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
    look(vectors, line, begin, sentAt, into);
  }

  /** Draws a line's delays in all worlds, at one index in the random sequence. */
  void draw(int place, int line, long begin, int[] sentAt, int[] into) {
    int[] keys = keysOf(line);
    IntVector there = IntVector.broadcast(INTS, place + placeOfLine(line));
    for (int i = 0; i < WORLDS; i += LANES)
      IntVector.fromArray(INTS, keys, i).add(there).intoArray(into, i);
    look(ALL, line, begin, sentAt, into);
  }

  /** Draws the delays of an agent's requests to all vehicles and of their answers. Each request is sent when
   * the previous one is answered.
   *
   * @param askedAt time of the first request, in grains from {@code begin}
   * @param into receives, for each vehicle, the request's delays, then the answer's delays
   */
  void drawInTurn(LaneVectors vectors, int[] places, int asker, long begin, int[] askedAt, int[][] into) {
    if (!isSteady) System.arraycopy(askedAt, 0, sentAt, 0, WORLDS);
    for (int line = 0; line < into.length; line++) {
      draw(vectors, places, Delays.question(asker, line / 2) + line % 2, begin, sentAt, into[line]);
      if (!isSteady) add(vectors, into[line], sentAt);
    }
  }

  static void add(LaneVectors vectors, int[] spans, int[] times) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector.fromArray(INTS, times, i).add(IntVector.fromArray(INTS, spans, i)).intoArray(times, i);
    }
  }

  /** Replaces indices in the random sequence by delays. */
  private void look(LaneVectors vectors, int line, long begin, int[] sentAt, int[] values) {
    if (changes) chooseTables(vectors, begin, sentAt);
    IntVector multiplier1 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_1),
        multiplier2 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_2);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector a = IntVector.fromArray(INTS, values, i);
      a = a.lanewise(XOR, a.lanewise(LSHR, 16)).mul(multiplier1);
      a = a.lanewise(XOR, a.lanewise(LSHR, 15)).mul(multiplier2);
      if (loses) a.lanewise(XOR, a.lanewise(LSHR, 16)).intoArray(bits, i);
      a.lanewise(LSHR, DROP).add(IntVector.fromArray(INTS, tableOf, i)).intoArray(values, i);
    }
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector.fromArray(INTS, delays, 0, values, i).intoArray(values, i);
    }
    if (loses) lose(vectors, line, begin, sentAt, values);
  }

  private void lose(LaneVectors vectors, int line, long begin, int[] sentAt, int[] values) {
    if (!losesByTime) {
      for (int k = 0; k < vectors.count; k++) await(vectors.first[k], values);
      return;
    }
    int[] from = calmFrom[calmOf(line)], until = calmUntil[calmOf(line)];
    IntVector coarse = IntVector.broadcast(INTS, (int) (begin >> COARSE));
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      VectorMask<Integer> mayLose =
          IntVector.fromArray(INTS, bits, i).and(LOW_BITS).compare(LT, IntVector.fromArray(INTS, lossThreshold, i));
      // The sum of two times without their low bits is that of the sum, or one less.
      IntVector at = IntVector.fromArray(INTS, sentAt, i).lanewise(ASHR, COARSE).add(coarse);
      mayLose =
          mayLose
              .or(at.compare(LE, IntVector.fromArray(INTS, from, i)))
              .or(at.compare(GE, IntVector.fromArray(INTS, until, i).sub(1)));
      // Without a message there is no time.
      mayLose = mayLose.and(IntVector.fromArray(INTS, sentAt, i).compare(NE, Integer.MAX_VALUE));
      for (long lanes = mayLose.toLong(); lanes != 0; lanes &= lanes - 1)
        lose(i + Long.numberOfTrailingZeros(lanes), line, begin, sentAt, values);
    }
  }

  /** Adds {@link LossyDelays#waitNs} where messages are lost, whatever the time. */
  private void await(int i, int[] values) {
    IntVector drawn = IntVector.fromArray(INTS, bits, i),
        threshold = IntVector.fromArray(INTS, lossThreshold, i),
        most = IntVector.fromArray(INTS, mostTries, i),
        wait = IntVector.fromArray(INTS, timeout, i),
        value = IntVector.fromArray(INTS, values, i);
    VectorMask<Integer> lost = drawn.and(LOW_BITS).compare(LT, threshold).and(most.compare(GT, 0));
    for (int tries = 1; lost.anyTrue(); tries++) {
      value = value.add(wait, lost);
      wait = wait.add(wait);
      IntVector one = drawn.add(tries * WorldRandom.STRIDE);
      one = one.lanewise(XOR, one.lanewise(LSHR, 16)).mul(WorldRandom.MULTIPLIER_1);
      one = one.lanewise(XOR, one.lanewise(LSHR, 15)).mul(WorldRandom.MULTIPLIER_2);
      one = one.lanewise(XOR, one.lanewise(LSHR, 16)).and(LOW_BITS);
      lost = lost.and(one.compare(LT, threshold)).and(most.compare(GT, tries));
    }
    value.intoArray(values, i);
  }

  private void lose(int world, int line, long begin, int[] sentAt, int[] values) {
    LossyDelays losses = lossy[world];
    if (losses == null) return;
    LossTimes times = lossTimes[world];
    int grain = DelayTable.GrainNs();
    long at = (begin + sentAt[world]) * grain;
    values[world] += (int) (losses.waitNs(times, bits[world], line, at) / grain);
    if (losses.isTimed() && !times.isLost(line & 1, at)) {
      calmFrom[calmOf(line)][world] = times.calmFromNs() == Long.MIN_VALUE ? -1 : coarse(times.calmFromNs());
      calmUntil[calmOf(line)][world] = coarse(times.calmUntilNs());
    }
  }

  /** Requests are drawn further ahead than commands, so each direction has a loss-free time for both. */
  private static int calmOf(int line) {
    return line & 1 | (Delays.isCommand(line) ? 2 : 0);
  }

  private static int coarse(long ns) {
    return (int) Math.min(Integer.MAX_VALUE, ns / DelayTable.GrainNs() >> COARSE);
  }

  /** Chooses the table of each world's message, by its time of sending. */
  private void chooseTables(LaneVectors vectors, long begin, int[] sentAt) {
    for (int k = 0; k < vectors.count; k++)
      for (int i = vectors.first[k], end = i + LANES; i < end; i++)
        tableOf[i] = courses[i].tableAt(begin + sentAt[i]);
  }
}
