package skein.lanes;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.NE;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.DelayTable;
import skein.forward.Delays;
import skein.forward.LoopTiming;
import skein.simd.WorldRandom;

/**
 * The tasks of the {@code futures} loop: each period one for either vehicle, which reads both one
 * after the other, and offers its own vehicle what was read. Tasks overlap and overtake; with the
 * window full they begin later, in turn, when a task has ended: no earlier than that one of all
 * which ends as the n-th from behind, where n may be under way.
 */
final class FuturesOffers extends LaneOffers {
  private static final int STEP = Delays.Lines() * WorldRandom.STRIDE;

  /** Tasks last for longer and for shorter by about so much. */
  private static final double AHEAD_S = 0.2;

  /** Long past. */
  private static final int PAST = -1_000_000_000;

  private final int periodGrains, timeoutGrains, ahead, most;

  /** Steps kept: a power of two. */
  private final int ring;

  // Tasks by agent and slot, from their own step's begin: when they end with an offer, when the
  // vehicles are read.
  private final int[][][] end, readEvader, readPursuer;

  /** The latest ends of all tasks before, the latest first, from the begin of the step known last. */
  private final int[][] latest;

  /** When the first task of the last step that was not missed began. */
  private final int[] began = new int[WORLDS];

  private final int[][] drawn = new int[8][WORLDS];

  /** Steps that may have offers still, and the next to be drawn. */
  private int oldest, next;

  // By agent: the next offer, the one behind it, and the step of the next.
  private final int[][] soonest = new int[2][WORLDS],
      second = new int[2][WORLDS],
      stepOf = new int[2][WORLDS],
      evaderAt = new int[2][WORLDS],
      pursuerAt = new int[2][WORLDS];
  private final int[] beatPlaces = new int[WORLDS], beatEvader = new int[WORLDS], beatPursuer = new int[WORLDS];
  private int row;

  /** In which some world was offered something in this beat. */
  private final LaneVectors taken = new LaneVectors();

  /**
   * @param maxDelayS the longest one-way delay of any link
   */
  FuturesOffers(LoopTiming.Futures timing, double maxDelayS) {
    super(new LaneDelays(), false, (int) Math.ceil(AHEAD_S / timing.periodS()));
    double periodS = timing.periodS(), longestS = timing.asking().timeoutS() * 4;
    periodGrains = LaneViews.grains(periodS);
    timeoutGrains = LaneViews.grains(timing.asking().timeoutS());
    // A decision waits for the answer to the command before at most.
    ahead = 1 + rowsAhead + (int) Math.ceil((2 * maxDelayS + timing.steering().handoverS() + timing.steering().minIntervalS()) / periodS);
    ring = Integer.highestOneBit(2 * (ahead + (int) Math.ceil(longestS / periodS) + 4) - 1);
    most = 2 * timing.asking().window();
    end = new int[2][ring][WORLDS];
    readEvader = new int[2][ring][WORLDS];
    readPursuer = new int[2][ring][WORLDS];
    latest = new int[most][WORLDS];
    joinedAt = new int[WORLDS];
    nextAt = new int[WORLDS];
    sampledAt[0] = beatEvader;
    sampledAt[1] = beatPursuer;
    place[0] = beatPlaces;
    place[1] = beatPlaces;
  }

  @Override
  void start(int[] worldKeys, DelayTable[] links) {
    delays.start(worldKeys, links);
    for (int[] each : latest) Arrays.fill(each, PAST);
    Arrays.fill(began, PAST);
    whose = PURSUER;
    oldest = 0;
    next = 0;
    while (next < ahead) draw();
  }

  /** The tasks of one more step. */
  private void draw() {
    int step = next++, slot = step & ring - 1;
    for (int line = 0; line < 8; line++) delays.draw(step * STEP, line, drawn[line]);
    IntVector period = IntVector.broadcast(INTS, step == 0 ? 0 : periodGrains),
        past = IntVector.broadcast(INTS, PAST);
    for (int i = 0; i < WORLDS; i += LANES) {
      for (int[] each : latest) {
        IntVector.fromArray(INTS, each, i).sub(period).max(past).intoArray(each, i);
      }
      IntVector.fromArray(INTS, began, i).sub(period).max(past).intoArray(began, i);
    }
    begin(0, slot);
    begin(1, slot);
  }

  private void begin(int agent, int slot) {
    int[] lastOf = latest[most - 1], toEvader = drawn[4 * agent], fromEvader = drawn[4 * agent + 1];
    int[] toPursuer = drawn[4 * agent + 2], fromPursuer = drawn[4 * agent + 3];
    int[] ends = end[agent][slot], evader = readEvader[agent][slot], pursuer = readPursuer[agent][slot];
    IntVector none = IntVector.broadcast(INTS, NONE),
        past = IntVector.broadcast(INTS, PAST),
        zero = IntVector.broadcast(INTS, 0),
        timeout = IntVector.broadcast(INTS, timeoutGrains);
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector before = IntVector.fromArray(INTS, began, i);
      // A step whose predecessor waits still is missed. The second task follows the first.
      VectorMask<Integer> goes =
          agent == 0 ? before.compare(LE, zero) : IntVector.fromArray(INTS, missed, i).compare(EQ, 0);
      IntVector begin = IntVector.fromArray(INTS, lastOf, i).max(agent == 0 ? zero : before.max(zero));
      if (agent == 0) {
        before.blend(begin, goes).intoArray(began, i);
        zero.blend(1, goes.not()).intoArray(missed, i);
      }
      IntVector there = IntVector.fromArray(INTS, toEvader, i),
          first = IntVector.fromArray(INTS, fromEvader, i).add(there),
          thereToo = IntVector.fromArray(INTS, toPursuer, i),
          second = IntVector.fromArray(INTS, fromPursuer, i).add(thereToo);
      VectorMask<Integer> fails = first.compare(GT, timeout);
      IntVector middle = begin.add(first.min(timeout));
      IntVector over = middle.add(second.min(timeout)).blend(middle, fails);
      VectorMask<Integer> offers = goes.andNot(fails.or(second.compare(GT, timeout)));
      none.blend(over, offers).intoArray(ends, i);
      begin.add(there).intoArray(evader, i);
      middle.add(thereToo).intoArray(pursuer, i);
      IntVector more = past.blend(over, goes);
      for (int[] each : latest) {
        IntVector held = IntVector.fromArray(INTS, each, i);
        held.max(more).intoArray(each, i);
        more = held.min(more);
      }
    }
  }

  /** 1 where the step drawn last has no tasks. */
  private final int[] missed = new int[WORLDS];

  @Override
  void startRow(int number) {
    row = number;
    draw();
    while (oldest < row && isOver(oldest & ring - 1)) oldest++;
    if (next - oldest > ring)
      throw new IllegalStateException("more than " + ring + " steps have tasks under way");
    taken.count = 0;
    for (int i = 0; i < WORLDS; i += LANES) taken.first[taken.count++] = i;
    Arrays.fill(joinedAt, NONE);
    look(EVADER);
    look(PURSUER);
  }

  private boolean isOver(int slot) {
    IntVector none = IntVector.broadcast(INTS, NONE);
    for (int[][] each : end)
      for (int i = 0; i < WORLDS; i += LANES)
        if (IntVector.fromArray(INTS, each[slot], i).compare(NE, none).anyTrue()) return false;
    return true;
  }

  @Override
  boolean nextBeat() {
    if (!isBefore(soonest[EVADER], periodGrains) && !isBefore(soonest[PURSUER], periodGrains)) return false;
    do whose = 1 - whose;
    while (!take(whose));
    return true;
  }

  /** Takes an agent's next offers where the other has none before; of one moment the evader's are first. */
  private boolean take(int agent) {
    int[] own = soonest[agent], other = soonest[1 - agent];
    IntVector horizon = IntVector.broadcast(INTS, (1 + rowsAhead) * periodGrains),
        none = IntVector.broadcast(INTS, NONE),
        first = IntVector.broadcast(INTS, agent == EVADER ? 1 : 0),
        here = IntVector.broadcast(INTS, row);
    taken.count = 0;
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector time = IntVector.fromArray(INTS, own, i), rival = IntVector.fromArray(INTS, other, i);
      VectorMask<Integer> due = time.compare(LT, horizon).and(time.sub(first).compare(LT, rival));
      none.blend(time, due).intoArray(joinedAt, i);
      if (due.anyTrue()) {
        taken.first[taken.count++] = i;
        IntVector.fromArray(INTS, second[agent], i).intoArray(nextAt, i);
        IntVector.fromArray(INTS, evaderAt[agent], i).intoArray(beatEvader, i);
        IntVector.fromArray(INTS, pursuerAt[agent], i).intoArray(beatPursuer, i);
        IntVector.fromArray(INTS, stepOf[agent], i).sub(here).mul(STEP).intoArray(beatPlaces, i);
      }
    }
    if (taken.count > 0) look(agent);
    return taken.count > 0;
  }

  /**
   * Which offers an agent has next, in vectors in which it took some, or may have more; what it took is over.
   */
  private void look(int agent) {
    int[][] ends = end[agent], evaders = readEvader[agent], pursuers = readPursuer[agent];
    IntVector none = IntVector.broadcast(INTS, NONE), zero = IntVector.broadcast(INTS, 0);
    for (int k = 0; k < taken.count; k++) {
      int i = taken.first[k];
      VectorMask<Integer> gone = IntVector.fromArray(INTS, joinedAt, i).compare(NE, none);
      IntVector last = IntVector.broadcast(INTS, -1).blend(IntVector.fromArray(INTS, stepOf[agent], i), gone);
      IntVector first = zero.add(none), then = zero.add(none), which = zero.add(zero);
      IntVector evader = zero.add(zero), pursuer = zero.add(zero);
      for (int step = oldest; step < next; step++) {
        int slot = step & ring - 1, shift = (step - row) * periodGrains;
        IntVector time = IntVector.fromArray(INTS, ends[slot], i);
        time = time.blend(none, last.compare(EQ, step));
        time.intoArray(ends[slot], i);
        time = time.add(shift, time.compare(NE, none));
        VectorMask<Integer> sooner = time.compare(LT, first);
        then = then.min(first.max(time));
        first = first.min(time);
        which = which.blend(step, sooner);
        evader = evader.blend(IntVector.fromArray(INTS, evaders[slot], i).add(shift), sooner);
        pursuer = pursuer.blend(IntVector.fromArray(INTS, pursuers[slot], i).add(shift), sooner);
      }
      first.intoArray(soonest[agent], i);
      then.intoArray(second[agent], i);
      which.intoArray(stepOf[agent], i);
      evader.intoArray(evaderAt[agent], i);
      pursuer.intoArray(pursuerAt[agent], i);
    }
  }
}
