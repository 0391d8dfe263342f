package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import java.util.function.Supplier;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.DelayTable;
import skein.forward.Delays;
import skein.forward.LoopTiming;
import skein.forward.Nanos;
import skein.forward.TabledDelays;
import skein.lanes.policy.LanePolicy;
import skein.simd.WorldRandom;

/** The views of many worlds under the {@code stream} loop, period by period: period m has the view of request
 * m. Nearly always all its answers arrive before anything of the next period, which SIMD code computes here.
 * Otherwise a {@link ViewSource} computes the world's views one by one, until the regular case returns; a
 * period may then have no view of the world, or several. So a period has one or more rounds, each with at
 * most one view per world.
 *
 * <p>Times are in grains of 4 ns ({@link DelayTable#GrainNs}) from the period's tick, and equal to those of
 * {@link Rollout} to the nanosecond.
 */
public final class LaneViews {
  static final int WORLDS = LanePolicy.WORLDS;
  final int vehicles;

  static final int GRAIN_NS = DelayTable.GrainNs();

  /** Duration of a grain, s; see {@link DelayTable#GrainNs}. */
  public static final float GRAIN_S = GRAIN_NS * 1e-9f;

  public static final int NONE = Integer.MAX_VALUE;

  /** Maximum of a time; later times are clipped to it. */
  private static final int LATEST = 2_000_000_000;

  private static final int[] AT_ONCE = new int[WORLDS];
  private static final LaneVectors ALL = LaneVectors.all();

  /** Number of periods that are stored, more than the periods computed ahead. */
  private static final int ROWS = 8;

  /** Maximum number of periods within which a request is answered in the regular case, so that no later
   * period's request is answered first and the window is never full.
   */
  static final int MOST_AHEAD = 4;

  /** Number of periods by which a view may be known before its own period. */
  static final int ROWS_EARLY = 1;

  private final int ahead;

  private final long periodNs;

  /** Whether SIMD computes the regular case; if false, all views are computed one by one. */
  private final boolean shortCut;

  private final int periodGrains;
  private final int patienceGrains, latestGrains;

  /** The source of each world, created when a world's views must first be computed one by one. */
  private final ViewSource[] sources = new ViewSource[WORLDS];

  private final Supplier<ViewSource> newSource;

  private int[] keys;
  private TabledDelays[] links;

  final LaneDelays delays = new LaneDelays();
  final MissingReadings missing;

  // By period modulo ROWS: times at which the requests reach the vehicles, of the first and the last answer,
  // and of the next period's last answer.
  private final int[][][] reached;
  private final int[][] first = new int[ROWS][WORLDS],
      last = new int[ROWS][WORLDS],
      nextLast = new int[ROWS][WORLDS];

  private final int[] drawn = new int[4 * LANES];
  private final int[] roundTrip = new int[WORLDS], otherRoundTrip = new int[WORLDS];

  /** Bit mask of the lanes that {@link #ask} found irregular, for each vector. */
  private final long[] irregularLanes = new long[WORLDS / LANES];

  // Worlds whose views are computed one by one: their periods, from and up to; and their indices.
  private final int[] irregularFrom = new int[WORLDS], irregularUpTo = new int[WORLDS];
  private final int[] irregular = new int[WORLDS];
  private int irregularCount;

  /** Whether a world's source has a view that has not been inserted yet. */
  private final boolean[] hasNext = new boolean[WORLDS];

  // The round's views: the time of each and of the world's next; the indices of its readings' requests in the
  // random sequence, relative to those of the period; and the times of the readings.
  int[] joinedAt, nextAt;
  final int[][] place;
  int[][] sampledAt;

  /** Whether some world has no view in this round, or a view with an old reading. */
  boolean hasOld;

  /** Whether some reading of the round was requested in another period. */
  private boolean hasOther;

  /** Of each vehicle, 1 in worlds where the round's view has a new reading of it, else 0. */
  final int[][] isFresh;

  private int row;

  /** The last step that was checked for irregularities. */
  private int lookedAt;

  private boolean more;

  LaneViews(
      LoopTiming.Stream timing,
      int vehicles,
      double durationS,
      double maxDelayS,
      boolean shortCut,
      MissingReadings missing) {
    this.vehicles = vehicles;
    this.missing = missing;
    reached = new int[ROWS][vehicles][WORLDS];
    place = new int[vehicles][WORLDS];
    isFresh = new int[vehicles][WORLDS];
    this.shortCut = shortCut;
    periodNs = Nanos.of(timing.periodS());
    ahead = Math.min(MOST_AHEAD, timing.asking().window());
    periodGrains = grains(timing.periodS());
    patienceGrains = grains(timing.patienceS());
    latestGrains = Math.min(grains(timing.asking().timeoutS()), ahead * periodGrains - 1);
    newSource = () -> ViewSource.apply(timing, missing.noises(), durationS, maxDelayS, ahead);
  }

  public static int grains(double seconds) {
    return (int) (Nanos.of(seconds) / GRAIN_NS);
  }

  public static boolean isWhole(double seconds) {
    return Nanos.of(seconds) % GRAIN_NS == 0;
  }

  /** Resets to the start of an episode with these worlds. */
  void start(int[] worldKeys, TabledDelays[] worldLinks) {
    keys = worldKeys;
    links = worldLinks;
    irregularCount = 0;
    Arrays.fill(irregularUpTo, -1);
    Arrays.fill(hasNext, false);
    row = -1;
    hasOther = true;
    for (int step = 0; step < ahead; step++) ask(step);
  }

  /** Computes when request {@code step} reaches each vehicle and when it is answered. Then checks whether the
   * view of the previous step consists exactly of that step's answers; worlds where it does not become
   * irregular. An answer of this step may precede views of earlier steps, but not the view of the present
   * period.
   */
  private void ask(int step) {
    for (int vehicle = 0; vehicle < vehicles; vehicle += 2) answer(vehicle, step);
    if (missing.areSome)
      // Without an answer from each vehicle, the next step's check finds this one irregular.
      for (int v = 0; v < vehicles; v++)
        missing.replace(v, (long) step * periodGrains, reached[step % ROWS][v], last[step % ROWS], LATEST);
    if (step > 0) {
      lookedAt = step;
      for (int i = 0; i < irregularLanes.length; i++)
        for (long lanes = shortCut ? irregularLanes[i] : -1L >>> -LANES; lanes != 0; lanes &= lanes - 1) {
          int world = i * LANES + Long.numberOfTrailingZeros(lanes);
          if (irregularUpTo[world] < step - 1) makeIrregular(world, row + 1);
        }
    }
  }

  /** Computes the answers of one vehicle and the next, if there is one. The delays of such a pair come from
   * one random sequence, and a table look-up takes as long as a dozen other operations, which overlap with
   * it.
   */
  private void answer(int vehicle, int step) {
    int place = LaneDelays.placeOf(step), slot = step % ROWS, slotBefore = (step + ROWS - 1) % ROWS;
    boolean isFirst = vehicle == 0, isLast = vehicle + 2 >= vehicles, isAlone = vehicle + 1 == vehicles;
    int other = isAlone ? vehicle : vehicle + 1;
    int[][] to = reached[slot], toBefore = reached[slotBefore];
    boolean isSteady = delays.isSteady;
    if (!isSteady) {
      draw(vehicle, step, to[vehicle], roundTrip);
      draw(other, step, to[other], otherRoundTrip);
    }
    int[] keys = delays.keysOf(Delays.question(0, vehicle)), tableOf = delays.tableOf, table = delays.delays;
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
      IntVector toOne, one, toTwo, two;
      if (isSteady) {
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
        toOne = IntVector.fromArray(INTS, table, 0, drawn, 0);
        one = IntVector.fromArray(INTS, table, 0, drawn, LANES).add(toOne);
        toTwo = isAlone ? toOne : IntVector.fromArray(INTS, table, 0, drawn, 2 * LANES);
        two = isAlone ? one : IntVector.fromArray(INTS, table, 0, drawn, 3 * LANES).add(toTwo);
      } else {
        toOne = IntVector.fromArray(INTS, to[vehicle], i);
        one = IntVector.fromArray(INTS, roundTrip, i);
        toTwo = IntVector.fromArray(INTS, to[other], i);
        two = IntVector.fromArray(INTS, otherRoundTrip, i);
      }
      toOne.intoArray(to[vehicle], i);
      toTwo.intoArray(to[other], i);
      IntVector soonest = one.min(two), slowest = one.max(two);
      VectorMask<Integer> overtakes =
          IntVector.fromArray(INTS, toBefore[vehicle], i)
              .compare(GE, toOne.add(period))
              .or(IntVector.fromArray(INTS, toBefore[other], i).compare(GE, toTwo.add(period)));
      if (!isFirst) {
        soonest = soonest.min(IntVector.fromArray(INTS, first[slot], i));
        slowest = slowest.max(IntVector.fromArray(INTS, last[slot], i));
      }
      soonest.intoArray(first[slot], i);
      slowest.intoArray(last[slot], i);
      long irregular = isFirst ? 0 : irregularLanes[i / LANES];
      if (isLast) {
        slowest.add(period).intoArray(nextLast[slotBefore], i);
        IntVector end = IntVector.fromArray(INTS, last[slotBefore], i);
        overtakes =
            end.compare(GE, soonest.add(period))
                .or(end.sub(IntVector.fromArray(INTS, first[slotBefore], i)).compare(GE, patience))
                .or(latest.compare(LT, end))
                .or(overtakes);
      }
      irregularLanes[i / LANES] = irregular | overtakes.toLong();
    }
  }

  /** Computes when a step's request reaches a vehicle and when it is answered, for links whose tables change
   * or that lose packets.
   */
  private void draw(int vehicle, int step, int[] to, int[] roundTrip) {
    int place = LaneDelays.placeOf(step), line = Delays.question(0, vehicle);
    long begin = (long) step * periodGrains;
    delays.draw(place, line, begin, AT_ONCE, to);
    delays.draw(place, line + 1, begin, to, roundTrip);
    LaneDelays.add(ALL, to, roundTrip);
  }

  private void makeIrregular(int world, int step) {
    if (hasNext[world]) {
      // The world was expected to be regular again after the next view.
      stayIrregular(world);
    } else {
      irregular[irregularCount++] = world;
      irregularFrom[world] = step;
      if (sources[world] == null) sources[world] = newSource.get();
      sources[world].begin(keys[world], links[world], step);
      goOn(world);
    }
  }

  private void stayIrregular(int world) {
    irregularUpTo[world] = Integer.MAX_VALUE;
  }

  /** Moves to the next view of an irregular world, and checks whether the world is regular after it. */
  private void goOn(int world) {
    ViewSource source = sources[world];
    source.next();
    hasNext[world] = true;
    boolean isRegular = source.isRegular() && shortCut;
    for (int step = source.row() + 1; isRegular && step < lookedAt; step++)
      isRegular = isRegular(world, step);
    if (isRegular) irregularUpTo[world] = source.row();
    else stayIrregular(world);
  }

  /** Whether one world is regular in a step, according to the criteria of {@link #ask}. */
  private boolean isRegular(int world, int step) {
    int[][] to = reached[step % ROWS], nextTo = reached[(step + 1) % ROWS];
    int end = last[step % ROWS][world];
    for (int v = 0; v < vehicles; v++)
      if (to[v][world] >= nextTo[v][world] + periodGrains) return false;
    return end < first[(step + 1) % ROWS][world] + periodGrains
        && end - first[step % ROWS][world] < patienceGrains
        && end <= latestGrains;
  }

  /** Moves to the first round of a period; periods are processed in order, from 0. */
  void startRow(int number) {
    row = number;
    ask(row + ahead);
    int slot = row % ROWS;
    joinedAt = last[slot];
    nextAt = nextLast[slot];
    sampledAt = reached[slot];
    if (hasOther) for (int[] places : place) Arrays.fill(places, 0);
    hasOther = false;
    hasOld = false;
    more = irregularCount > 0;
    if (more) {
      for (int[] each : isFresh) Arrays.fill(each, 1);
      irregularBeat(true);
    }
  }

  /** Moves to the next round of the period, if it has one. */
  boolean nextBeat() {
    if (!more) return false;
    Arrays.fill(joinedAt, NONE);
    for (int[] each : isFresh) Arrays.fill(each, 0);
    hasOld = true;
    return irregularBeat(false);
  }

  /** Inserts the views of irregular worlds into the round. A world without a view in this period may have
   * several in the next; then the first of them is inserted here, because an additional round costs all
   * worlds.
   *
   * @return whether a view was inserted
   */
  private boolean irregularBeat(boolean isFirst) {
    more = false;
    boolean any = false;
    int kept = 0;
    for (int i = 0; i < irregularCount; i++) {
      int world = irregular[i];
      ViewSource source = sources[world];
      boolean isEarly =
          isFirst && irregularFrom[world] <= row && source.row() == row + ROWS_EARLY && !source.isRegular();
      if (source.row() == row || isEarly) {
        any = true;
        put(world, source);
        if (irregularUpTo[world] == source.row()) hasNext[world] = false;
        else {
          goOn(world);
          nextAt[world] = fromTick(source.joinedAt());
          if (source.row() == row) {
            more = true;
            // The next period was already checked.
            stayIrregular(world);
          }
        }
      } else if (isFirst && irregularFrom[world] <= row) {
        joinedAt[world] = NONE;
        for (int[] each : isFresh) each[world] = 0;
        hasOld = true;
      } else if (isFirst) nextAt[world] = fromTick(source.joinedAt());
      if (hasNext[world]) irregular[kept++] = world;
    }
    irregularCount = kept;
    return any;
  }

  private void put(int world, ViewSource source) {
    joinedAt[world] = fromTick(source.joinedAt());
    for (int v = 0; v < vehicles; v++) {
      int at = fromTick(source.sampledAt()[v]);
      sampledAt[v][world] = at;
      place[v][world] = LaneDelays.placeOf(source.question()[v]) - LaneDelays.placeOf(row);
      hasOther |= place[v][world] != 0;
      isFresh[v][world] = source.isFresh()[v] ? 1 : 0;
      hasOld |= !source.isFresh()[v];
    }
  }

  private int fromTick(long timeNs) {
    long grains = (timeNs - row * periodNs) / GRAIN_NS;
    return (int) Math.max(-LATEST, Math.min(LATEST, grains));
  }
}
