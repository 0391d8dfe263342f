package skein.rollout;

import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.rollout.LaneMath.INTS;
import static skein.rollout.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;

/**
 * The pictures of many worlds under the {@code stream} loop, row by row: row m has the picture of
 * questions m. Nearly always both are answered before anything of the next row, which is looked
 * after here by lanes; where it is not so, the world's pictures come one by one from a {@link
 * PictureSource} until it is so again. Then a row may have no picture of a world, or several: so a
 * row has one or more beats, with at most one picture each.
 *
 * <p>Times are in grains of 4 ns ({@link DelayTable#GrainNs}) from the row's tick, and the same as in
 * {@link Rollout} to the nanosecond.
 */
final class LanePictures {
  static final int WORLDS = LanePolicy.WORLDS;
  private static final int VEHICLES = 2;

  /** In the place of a time: no picture. */
  static final int NONE = Integer.MAX_VALUE;

  /** As late as a time counts. */
  private static final int LATEST = 2_000_000_000;

  /** Rows kept: more than are looked ahead. */
  private static final int ROWS = 8;

  /**
   * Rows within which questions are answered where all is regular, at most: no question of a later
   * row can be answered before, and the window is never full.
   */
  private static final int MOST_AHEAD = 4;

  private final int ahead;

  private static final IntVector MULTIPLIER_1 =
          IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_1),
      MULTIPLIER_2 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_2);

  private final long periodNs;
  private final boolean shortCut;
  private final IntVector period, patience, latest;
  private final PictureSource[] sources = new PictureSource[WORLDS];

  private int[] keys;
  private DelayTable[] links;

  /** The delays of all links, one table after the other; and where each world's begins. */
  private int[] delays = new int[DelayTable.Size()];

  final int[] tableOf = new int[WORLDS];
  private final DelayTable[] tables = new DelayTable[WORLDS];
  private int tableCount = 0;

  private final int[] there = new int[WORLDS], back = new int[WORLDS];

  // By row modulo ROWS and vehicle: when the question reaches it, and when the answer is back.
  private final int[][][] reached = new int[ROWS][VEHICLES][WORLDS],
      answered = new int[ROWS][VEHICLES][WORLDS];

  /** When both answers are back. */
  private final int[][] both = new int[ROWS][WORLDS];

  // Worlds whose pictures come one by one: from which row to which; these worlds.
  private final int[] irregularFrom = new int[WORLDS], irregularUpTo = new int[WORLDS];
  private final int[] irregular = new int[WORLDS];
  private int irregularCount;

  /** Whether a world's source tells a picture that has not had its beat. */
  private final boolean[] hasNext = new boolean[WORLDS];

  // The beat's pictures: when each is joined, when the world's next one is; what its readings were
  // asked as, times the places of a step; when they were taken.
  int[] joinedAt = new int[WORLDS], nextAt = new int[WORLDS];
  final int[][] place = new int[VEHICLES][WORLDS];
  int[][] sampledAt = new int[VEHICLES][];

  /** Whether a world has no picture in this beat, or one with an old reading. */
  boolean hasOld;

  /** Whether a reading is older than its row. */
  boolean hasEarly;

  /** 1 where the beat's picture has a reading of the vehicle that the picture before had not. */
  final int[][] isFresh = new int[VEHICLES][WORLDS];

  private final int[][] ownSampledAt = new int[VEHICLES][WORLDS];

  /** Longest delay of any link, s. */
  float maxS;

  /** No reading of the beat is taken later, s. */
  float latestSampleS;

  private int row;

  /** Steps that were looked at for what is irregular. */
  private int lookedAt;

  private boolean more;

  LanePictures(LoopTiming.Stream timing, double durationS, boolean shortCut) {
    this.shortCut = shortCut;
    periodNs = Math.round(timing.periodS() * 1e9);
    ahead = Math.min(MOST_AHEAD, timing.asking().window());
    int periodGrains = grains(timing.periodS());
    period = IntVector.broadcast(INTS, periodGrains);
    patience = IntVector.broadcast(INTS, grains(timing.patienceS()));
    latest =
        IntVector.broadcast(
            INTS,
            Math.min(
                grains(timing.asking().timeoutS()),
                ahead * periodGrains - 1));
    for (int i = 0; i < WORLDS; i++) sources[i] = new PictureSource(timing, durationS, ahead);
  }

  static int grains(double seconds) {
    return (int) (Math.round(seconds * 1e9) / DelayTable.GrainNs());
  }

  /** Whether a time is a whole number of grains. */
  static boolean isWhole(double seconds) {
    return Math.round(seconds * 1e9) % DelayTable.GrainNs() == 0;
  }

  /** Back to the start of an episode. */
  void start(int[] worldKeys, DelayTable[] worldLinks) {
    keys = worldKeys;
    links = worldLinks;
    takeOver();
    irregularCount = 0;
    Arrays.fill(irregularUpTo, -1);
    Arrays.fill(hasNext, false);
    row = -1;
    for (int step = 0; step < ahead; step++) ask(step);
    for (int step = 0; step < ahead - 1; step++) findIrregular(step);
  }

  private void takeOver() {
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

  /** Two delays of each world, of its own step: on this line and on the next. */
  void draw(int[] places, int line, int[] first, int[] second) {
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
      x = x.lanewise(XOR, x.lanewise(LSHR, 16));
      y = y.lanewise(XOR, y.lanewise(LSHR, 16));
      x.lanewise(LSHR, DelayTable.Drop()).add(table).intoArray(there, i);
      y.lanewise(LSHR, DelayTable.Drop()).add(table).intoArray(back, i);
    }
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector.fromArray(INTS, delays, 0, there, i).intoArray(first, i);
      IntVector.fromArray(INTS, delays, 0, back, i).intoArray(second, i);
    }
  }

  private static int placeOf(int step) {
    return step * Rollout.Places() * WorldRandom.STRIDE;
  }

  /** When question {@code step} reaches the vehicles, and when it is answered. */
  private void ask(int step) {
    int slot = step % ROWS;
    int[][] to = reached[slot], from = answered[slot];
    for (int v = 0; v < VEHICLES; v++) {
      Arrays.fill(place[v], placeOf(step));
      draw(place[v], 2 * v, to[v], from[v]);
    }
    int[] last = both[slot];
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector evader =
          IntVector.fromArray(INTS, from[0], i).add(IntVector.fromArray(INTS, to[0], i));
      IntVector pursuer =
          IntVector.fromArray(INTS, from[1], i).add(IntVector.fromArray(INTS, to[1], i));
      evader.intoArray(from[0], i);
      pursuer.intoArray(from[1], i);
      evader.max(pursuer).intoArray(last, i);
    }
  }

  /**
   * Looks for worlds whose picture of a step is not simply that of the step's questions. An answer of
   * the step after it may have come before pictures of the steps before, but not before the one of
   * the row now.
   */
  private void findIrregular(int step) {
    int[][] to = reached[step % ROWS], from = answered[step % ROWS];
    int[][] nextTo = reached[(step + 1) % ROWS], nextFrom = answered[(step + 1) % ROWS];
    int[] last = both[step % ROWS];
    lookedAt = step + 1;
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector end = IntVector.fromArray(INTS, last, i);
      IntVector first =
          IntVector.fromArray(INTS, from[0], i).min(IntVector.fromArray(INTS, from[1], i));
      IntVector next =
          IntVector.fromArray(INTS, nextFrom[0], i)
              .min(IntVector.fromArray(INTS, nextFrom[1], i))
              .add(period);
      VectorMask<Integer> irregularHere =
          end.compare(GE, next)
              .or(end.sub(first).compare(GE, patience))
              .or(latest.compare(LT, end))
              .or(
                  IntVector.fromArray(INTS, to[0], i)
                      .compare(GE, IntVector.fromArray(INTS, nextTo[0], i).add(period)))
              .or(
                  IntVector.fromArray(INTS, to[1], i)
                      .compare(GE, IntVector.fromArray(INTS, nextTo[1], i).add(period)));
      if (irregularHere.anyTrue() || !shortCut)
        for (int lane = 0; lane < LANES; lane++)
          if ((irregularHere.laneIsSet(lane) || !shortCut) && irregularUpTo[i + lane] < step)
            makeIrregular(i + lane, row + 1);
    }
  }

  private void makeIrregular(int world, int step) {
    if (hasNext[world]) {
      // It was thought to be regular again behind the picture that comes next.
      stayIrregular(world);
    } else {
      irregular[irregularCount++] = world;
      irregularFrom[world] = step;
      sources[world].begin(keys[world], links[world], step);
      goOn(world);
    }
  }

  private void stayIrregular(int world) {
    sources[world].isRegular = false;
    irregularUpTo[world] = Integer.MAX_VALUE;
  }

  /** To the next picture of a world whose pictures come one by one. */
  private void goOn(int world) {
    PictureSource source = sources[world];
    source.next();
    hasNext[world] = true;
    boolean isRegular = source.isRegular && shortCut;
    for (int step = source.row + 1; isRegular && step < lookedAt; step++)
      isRegular = isRegular(world, step);
    if (isRegular) irregularUpTo[world] = source.row;
    else stayIrregular(world);
  }

  /** What {@link #findIrregular} looks for, of one world. */
  private boolean isRegular(int world, int step) {
    int[][] to = reached[step % ROWS], from = answered[step % ROWS];
    int[][] nextTo = reached[(step + 1) % ROWS], nextFrom = answered[(step + 1) % ROWS];
    int end = both[step % ROWS][world], first = Math.min(from[0][world], from[1][world]);
    int periodGrains = period.lane(0);
    return end < Math.min(nextFrom[0][world], nextFrom[1][world]) + periodGrains
        && end - first < patience.lane(0)
        && end <= latest.lane(0)
        && to[0][world] < nextTo[0][world] + periodGrains
        && to[1][world] < nextTo[1][world] + periodGrains;
  }

  /** To the first beat of a row; rows are taken in turn, from 0. */
  void startRow(int number) {
    row = number;
    ask(row + ahead);
    findIrregular(row + ahead - 1);
    int slot = row % ROWS, next = (row + 1) % ROWS;
    int[] after = both[next];
    for (int i = 0; i < WORLDS; i += LANES)
      IntVector.fromArray(INTS, after, i).add(period).intoArray(nextAt, i);
    joinedAt = both[slot];
    sampledAt[0] = reached[slot][0];
    sampledAt[1] = reached[slot][1];
    for (int v = 0; v < VEHICLES; v++) Arrays.fill(place[v], placeOf(row));
    hasOld = false;
    hasEarly = false;
    latestSampleS = maxS;
    more = irregularCount > 0;
    if (more) {
      Arrays.fill(isFresh[0], 1);
      Arrays.fill(isFresh[1], 1);
      irregularBeat(true);
    }
  }

  /** To the next beat of the row, if it has one. */
  boolean nextBeat() {
    if (!more) return false;
    Arrays.fill(joinedAt, NONE);
    Arrays.fill(isFresh[0], 0);
    Arrays.fill(isFresh[1], 0);
    hasOld = true;
    return irregularBeat(false);
  }

  /** Puts the beat's pictures of irregular worlds where the others' are; whether there were any. */
  private boolean irregularBeat(boolean isFirst) {
    more = false;
    boolean any = false;
    int kept = 0;
    for (int i = 0; i < irregularCount; i++) {
      int world = irregular[i];
      PictureSource source = sources[world];
      if (source.row == row) {
        any = true;
        put(world, source);
        if (source.isRegular && shortCut) hasNext[world] = false;
        else {
          goOn(world);
          nextAt[world] = fromTick(source.joinedAt);
          if (source.row == row) {
            more = true;
            // The next row was looked after already.
            stayIrregular(world);
          }
        }
      } else if (isFirst && irregularFrom[world] <= row) {
        joinedAt[world] = NONE;
        isFresh[0][world] = 0;
        isFresh[1][world] = 0;
        hasOld = true;
      } else if (isFirst) nextAt[world] = fromTick(source.joinedAt);
      if (hasNext[world]) irregular[kept++] = world;
    }
    irregularCount = kept;
    return any;
  }

  private void put(int world, PictureSource source) {
    joinedAt[world] = fromTick(source.joinedAt);
    for (int v = 0; v < VEHICLES; v++) {
      int at = fromTick(source.sampledAt[v]);
      sampledAt[v][world] = at;
      place[v][world] = placeOf(source.question[v]);
      isFresh[v][world] = source.isFresh[v] ? 1 : 0;
      hasOld |= !source.isFresh[v];
      hasEarly |= source.isFresh[v] && at < 0;
      // A question that had to wait was sent after its tick.
      if (source.isFresh[v])
        latestSampleS = Math.max(latestSampleS, at * (DelayTable.GrainNs() * 1.001e-9f));
    }
  }

  private int fromTick(long timeNs) {
    long grains = (timeNs - row * periodNs) / DelayTable.GrainNs();
    return (int) Math.max(-LATEST, Math.min(LATEST, grains));
  }
}
