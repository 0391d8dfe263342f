package skein.lanes;

import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import skein.forward.DelayTable;
import skein.forward.LoopTiming;
import skein.forward.Nanos;
import skein.simd.WorldRandom;

/**
 * The views of many worlds under the {@code stream} loop, row by row: row m has the view of
 * questions m. Nearly always both are answered before anything of the next row, which is looked
 * after here by lanes; where it is not so, the world's views come one by one from a {@link
 * ViewSource} until it is so again. Then a row may have no view of a world, or several: so a
 * row has one or more beats, with at most one view each.
 *
 * <p>Times are in grains of 4 ns ({@link DelayTable#GrainNs}) from the row's tick, and the same as in
 * {@link Rollout} to the nanosecond.
 */
final class LaneViews {
  static final int WORLDS = LanePolicy.WORLDS;
  private static final int VEHICLES = 2;

  private static final int GRAIN_NS = DelayTable.GrainNs();

  /** {@link DelayTable#GrainNs} in seconds. */
  static final float GRAIN_S = GRAIN_NS * 1e-9f;

  /** In the place of a time: no view. */
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

  private final long periodNs;
  private final boolean mayCut;

  /** Off where questions of one vehicle may overtake each other on their way to it. */
  private boolean shortCut;
  private final int periodGrains;
  private final int patienceGrains, latestGrains;
  private final ViewSource[] sources = new ViewSource[WORLDS];

  private int[] keys;
  private DelayTable[] links;

  final LaneDelays delays = new LaneDelays();

  // By row modulo ROWS: when the questions reach the vehicles, and when the first answer and both
  // are back; the same of the next row's answers.
  private final int[][][] reached = new int[ROWS][VEHICLES][WORLDS];
  private final int[][] first = new int[ROWS][WORLDS],
      both = new int[ROWS][WORLDS],
      nextBoth = new int[ROWS][WORLDS];

  private final int[] drawn = new int[4 * LANES];

  /** The lanes of each vector that {@link #ask} found irregular. */
  private final long[] irregularLanes = new long[WORLDS / LANES];

  // Worlds whose views come one by one: from which row to which; these worlds.
  private final int[] irregularFrom = new int[WORLDS], irregularUpTo = new int[WORLDS];
  private final int[] irregular = new int[WORLDS];
  private int irregularCount;

  /** Whether a world's source tells a view that has not had its beat. */
  private final boolean[] hasNext = new boolean[WORLDS];

  // The beat's views: when each is joined, when the world's next one is; what its readings were
  // asked as, in places from the row's; when they were taken.
  int[] joinedAt, nextAt;
  final int[][] place = new int[VEHICLES][WORLDS];
  int[][] sampledAt = new int[VEHICLES][];

  /** Whether a world has no view in this beat, or one with an old reading. */
  boolean hasOld;

  /** Whether some reading was asked as another than the row's. */
  private boolean hasOther;

  /** 1 where the beat's view has a reading of the vehicle that the view before had not. */
  final int[][] isFresh = new int[VEHICLES][WORLDS];

  private int row;

  /** Steps that were looked at for what is irregular. */
  private int lookedAt;

  private boolean more;

  LaneViews(LoopTiming.Stream timing, double durationS, boolean shortCut) {
    this.mayCut = shortCut;
    periodNs = Nanos.of(timing.periodS());
    ahead = Math.min(MOST_AHEAD, timing.asking().window());
    periodGrains = grains(timing.periodS());
    patienceGrains = grains(timing.patienceS());
    latestGrains = Math.min(grains(timing.asking().timeoutS()), ahead * periodGrains - 1);
    for (int i = 0; i < WORLDS; i++) sources[i] = new ViewSource(timing, durationS, ahead);
  }

  static int grains(double seconds) {
    return (int) (Nanos.of(seconds) / GRAIN_NS);
  }

  /** Whether a time is a whole number of grains. */
  static boolean isWhole(double seconds) {
    return Nanos.of(seconds) % GRAIN_NS == 0;
  }

  /** Back to the start of an episode. */
  void start(int[] worldKeys, DelayTable[] worldLinks) {
    shortCut = mayCut;
    for (DelayTable link : worldLinks)
      if ((link.maxS() - link.delaysS()[0]) * 1e9 >= periodNs) shortCut = false;
    keys = worldKeys;
    links = worldLinks;
    delays.start(worldKeys, worldLinks);
    irregularCount = 0;
    Arrays.fill(irregularUpTo, -1);
    Arrays.fill(hasNext, false);
    row = -1;
    hasOther = true;
    for (int step = 0; step < ahead; step++) ask(step);
  }

  /**
   * When question {@code step} reaches the vehicles, and when it is answered. With that, looks for
   * worlds whose view of the step before is not simply that of that step's questions. An answer of
   * this step may have come before views of the steps before, but not before the one of the row
   * now.
   */
  private void ask(int step) {
    answer(LaneDelays.placeOf(step), step % ROWS, (step + ROWS - 1) % ROWS);
    if (step > 0) {
      lookedAt = step;
      for (int i = 0; i < irregularLanes.length; i++)
        for (long lanes = shortCut ? irregularLanes[i] : -1L >>> -LANES; lanes != 0; lanes &= lanes - 1) {
          int world = i * LANES + Long.numberOfTrailingZeros(lanes);
          if (irregularUpTo[world] < step - 1) makeIrregular(world, row + 1);
        }
    }
  }

  private void answer(int place, int slot, int slotBefore) {
    int[][] to = reached[slot], toBefore = reached[slotBefore];
    int[] keys = delays.keys, tableOf = delays.tableOf, table = delays.delays;
    IntVector place0 = IntVector.broadcast(INTS, place),
        place1 = IntVector.broadcast(INTS, place + WorldRandom.STRIDE),
        place2 = IntVector.broadcast(INTS, place + 2 * WorldRandom.STRIDE),
        place3 = IntVector.broadcast(INTS, place + 3 * WorldRandom.STRIDE),
        multiplier1 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_1),
        multiplier2 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_2);
    IntVector period = IntVector.broadcast(INTS, periodGrains),
        patience = IntVector.broadcast(INTS, patienceGrains),
        latest = IntVector.broadcast(INTS, latestGrains);
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector key = IntVector.fromArray(INTS, keys, i),
          begin = IntVector.fromArray(INTS, tableOf, i);
      IntVector a = key.add(place0), b = key.add(place1), c = key.add(place2), d = key.add(place3);
      a = a.lanewise(XOR, a.lanewise(LSHR, 16)).mul(multiplier1);
      b = b.lanewise(XOR, b.lanewise(LSHR, 16)).mul(multiplier1);
      c = c.lanewise(XOR, c.lanewise(LSHR, 16)).mul(multiplier1);
      d = d.lanewise(XOR, d.lanewise(LSHR, 16)).mul(multiplier1);
      a = a.lanewise(XOR, a.lanewise(LSHR, 15)).mul(multiplier2);
      b = b.lanewise(XOR, b.lanewise(LSHR, 15)).mul(multiplier2);
      c = c.lanewise(XOR, c.lanewise(LSHR, 15)).mul(multiplier2);
      d = d.lanewise(XOR, d.lanewise(LSHR, 15)).mul(multiplier2);
      a.lanewise(LSHR, LaneDelays.DROP).add(begin).intoArray(drawn, 0);
      b.lanewise(LSHR, LaneDelays.DROP).add(begin).intoArray(drawn, LANES);
      c.lanewise(LSHR, LaneDelays.DROP).add(begin).intoArray(drawn, 2 * LANES);
      d.lanewise(LSHR, LaneDelays.DROP).add(begin).intoArray(drawn, 3 * LANES);
      IntVector toEvader = IntVector.fromArray(INTS, table, 0, drawn, 0),
          evader = IntVector.fromArray(INTS, table, 0, drawn, LANES).add(toEvader),
          toPursuer = IntVector.fromArray(INTS, table, 0, drawn, 2 * LANES),
          pursuer = IntVector.fromArray(INTS, table, 0, drawn, 3 * LANES).add(toPursuer);
      toEvader.intoArray(to[0], i);
      toPursuer.intoArray(to[1], i);
      IntVector soonest = evader.min(pursuer), last = evader.max(pursuer);
      soonest.intoArray(first[slot], i);
      last.intoArray(both[slot], i);
      last.add(period).intoArray(nextBoth[slotBefore], i);
      IntVector end = IntVector.fromArray(INTS, both[slotBefore], i);
      irregularLanes[i / LANES] =
          end.compare(GE, soonest.add(period))
              .or(end.sub(IntVector.fromArray(INTS, first[slotBefore], i)).compare(GE, patience))
              .or(latest.compare(LT, end))
              .or(IntVector.fromArray(INTS, toBefore[0], i).compare(GE, toEvader.add(period)))
              .or(IntVector.fromArray(INTS, toBefore[1], i).compare(GE, toPursuer.add(period)))
              .toLong();
    }
  }

  private void makeIrregular(int world, int step) {
    if (hasNext[world]) {
      // It was thought to be regular again behind the view that comes next.
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

  /** To the next view of a world whose views come one by one. */
  private void goOn(int world) {
    ViewSource source = sources[world];
    source.next();
    hasNext[world] = true;
    boolean isRegular = source.isRegular && shortCut;
    for (int step = source.row + 1; isRegular && step < lookedAt; step++)
      isRegular = isRegular(world, step);
    if (isRegular) irregularUpTo[world] = source.row;
    else stayIrregular(world);
  }

  /** Whether {@link #ask} found nothing irregular, in one world. */
  private boolean isRegular(int world, int step) {
    int[][] to = reached[step % ROWS], nextTo = reached[(step + 1) % ROWS];
    int end = both[step % ROWS][world];
    return end < first[(step + 1) % ROWS][world] + periodGrains
        && end - first[step % ROWS][world] < patienceGrains
        && end <= latestGrains
        && to[0][world] < nextTo[0][world] + periodGrains
        && to[1][world] < nextTo[1][world] + periodGrains;
  }

  /** To the first beat of a row; rows are taken in turn, from 0. */
  void startRow(int number) {
    row = number;
    ask(row + ahead);
    int slot = row % ROWS;
    joinedAt = both[slot];
    nextAt = nextBoth[slot];
    sampledAt[0] = reached[slot][0];
    sampledAt[1] = reached[slot][1];
    if (hasOther) for (int[] places : place) Arrays.fill(places, 0);
    hasOther = false;
    hasOld = false;
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

  /** Puts the beat's views of irregular worlds where the others' are; whether there were any. */
  private boolean irregularBeat(boolean isFirst) {
    more = false;
    boolean any = false;
    int kept = 0;
    for (int i = 0; i < irregularCount; i++) {
      int world = irregular[i];
      ViewSource source = sources[world];
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

  private void put(int world, ViewSource source) {
    joinedAt[world] = fromTick(source.joinedAt);
    for (int v = 0; v < VEHICLES; v++) {
      int at = fromTick(source.sampledAt[v]);
      sampledAt[v][world] = at;
      place[v][world] = LaneDelays.placeOf(source.question[v]) - LaneDelays.placeOf(row);
      hasOther |= place[v][world] != 0;
      isFresh[v][world] = source.isFresh[v] ? 1 : 0;
      hasOld |= !source.isFresh[v];
    }
  }

  private int fromTick(long timeNs) {
    long grains = (timeNs - row * periodNs) / GRAIN_NS;
    return (int) Math.max(-LATEST, Math.min(LATEST, grains));
  }
}
