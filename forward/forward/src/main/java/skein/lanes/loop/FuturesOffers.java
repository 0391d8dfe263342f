package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.NE;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.Delays;
import skein.forward.LoopTiming;
import skein.forward.TabledDelays;

/** The tasks of the {@code futures} loop. Every period has one task for each vehicle: it reads all vehicles
 * in sequence, and then offers the readings to its own vehicle. Tasks overlap and overtake one another. If n
 * tasks are unfinished, where n is the window, a new task waits until one of them ends.
 */
final class FuturesOffers extends LaneOffers {
  private static final int STEP = LaneDelays.placeOf(1);

  private static final double AHEAD_S = 0.2;

  private static final LaneVectors ALL = LaneVectors.all();

  private static final int PAST = -1_000_000_000;

  private final int periodGrains, timeoutGrains, ahead, most;

  /** Number of periods whose tasks are stored; a power of two. */
  private final int ring;

  // Of tasks, indexed by agent and slot, from the start of their own step: begin, and end with an offer.
  private final int[][][] beginAt, end;

  /** The n latest ends of all earlier tasks, the latest first, in grains from the start of the last drawn
   * period.
   */
  private final int[][] latest;

  /** Start of the first task in the last period that was not missed, in grains. */
  private final int[] began = new int[WORLDS];

  /** 1 in worlds in which the last drawn period has no tasks, else 0. */
  private final int[] missed = new int[WORLDS];

  /** For each vehicle, the delay of a task's request, then of its answer. */
  private final int[][] drawn;

  /** The vehicle that has no reading for a drawn task, if readings may be missing. */
  private final int[] missingOf = new int[WORLDS];

  /** The oldest period whose offers may still be pending, and the next period to draw. */
  private int oldest, next;

  // By agent: the next offer and the one after it; and the step and the begin of the next one's task.
  private final int[][] soonest, second, stepOf, beginOf;

  // Indices in the random sequences, of a drawn step or of this round's offers; and the times at which the
  // offers' tasks read the next vehicle.
  private final int[] places = new int[WORLDS], goesOn = new int[WORLDS];

  private final int[] beatPlaces = new int[WORLDS];
  private int row;

  /** Vectors in which some world has an offer in this round. */
  private final LaneVectors taken = new LaneVectors();

  /** @param maxDelayS the longest one-way delay of any link */
  FuturesOffers(
      LoopTiming.Futures timing, int vehicles, double maxDelayS, MissingReadings missing) {
    super(vehicles, new LaneDelays(), missing, false, (int) Math.ceil(AHEAD_S / timing.periodS()));
    double periodS = timing.periodS(),
        taskS = vehicles * Math.min(timing.asking().timeoutS(), 2 * maxDelayS);
    periodGrains = LaneViews.grains(periodS);
    timeoutGrains = LaneViews.grains(timing.asking().timeoutS());
    // A decision waits at most for the answer to the previous command.
    double waitsS = 2 * maxDelayS + timing.steering().handoverS() + timing.steering().minIntervalS();
    ahead = 1 + rowsAhead + (int) Math.ceil(waitsS / periodS);
    // A task may wait for one that waits for another.
    ring = Integer.highestOneBit(2 * (ahead + (int) Math.ceil(3 * taskS / periodS) + 4) - 1);
    most = vehicles * timing.asking().window();
    drawn = new int[2 * vehicles][WORLDS];
    soonest = new int[vehicles][WORLDS];
    second = new int[vehicles][WORLDS];
    stepOf = new int[vehicles][WORLDS];
    beginOf = new int[vehicles][WORLDS];
    beginAt = new int[vehicles][ring][WORLDS];
    end = new int[vehicles][ring][WORLDS];
    latest = new int[most][WORLDS];
    keepOffers(beatPlaces);
  }

  @Override
  void start(int[] worldKeys, TabledDelays[] links) {
    delays.start(worldKeys, links);
    for (int[] each : latest) Arrays.fill(each, PAST);
    Arrays.fill(began, PAST);
    whose = vehicles - 1;
    oldest = 0;
    next = 0;
    while (next < ahead) draw();
  }

  private void draw() {
    int step = next++, slot = step & ring - 1;
    IntVector period = IntVector.broadcast(INTS, step == 0 ? 0 : periodGrains),
        past = IntVector.broadcast(INTS, PAST);
    for (int i = 0; i < WORLDS; i += LANES) {
      for (int[] each : latest)
        IntVector.fromArray(INTS, each, i).sub(period).max(past).intoArray(each, i);
      IntVector.fromArray(INTS, began, i).sub(period).max(past).intoArray(began, i);
    }
    Arrays.fill(places, LaneDelays.placeOf(step));
    for (int agent = 0; agent < vehicles; agent++) {
      begin(agent, beginAt[agent][slot]);
      long stepBegin = (long) step * periodGrains;
      delays.drawInTurn(ALL, places, agent, stepBegin, beginAt[agent][slot], drawn);
      if (missing.areSome) missing.find(ALL, beginAt[agent][slot], stepBegin, drawn, missingOf);
      end(beginAt[agent][slot], end[agent][slot]);
    }
  }

  /** Computes the times at which an agent's tasks begin. */
  private void begin(int agent, int[] begins) {
    int[] lastOf = latest[most - 1];
    IntVector zero = IntVector.broadcast(INTS, 0);
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector before = IntVector.fromArray(INTS, began, i);
      IntVector begin = IntVector.fromArray(INTS, lastOf, i).max(agent == 0 ? zero : before.max(zero));
      if (agent == 0) {
        // A step is missed if its predecessor still waits, even if a time-out ends that wait at this moment,
        // because time-outs are last. The other tasks follow the first.
        VectorMask<Integer> goes = before.compare(LT, zero);
        before.blend(begin, goes).intoArray(began, i);
        zero.blend(1, goes.not()).intoArray(missed, i);
      }
      begin.intoArray(begins, i);
    }
  }

  /** Computes when an agent's tasks end; {@link LaneOffers#NONE} for a task without an offer. */
  private void end(int[] begins, int[] ends) {
    IntVector none = IntVector.broadcast(INTS, NONE),
        past = IntVector.broadcast(INTS, PAST),
        timeout = IntVector.broadcast(INTS, timeoutGrains);
    for (int i = 0; i < WORLDS; i += LANES) {
      VectorMask<Integer> goes = IntVector.fromArray(INTS, missed, i).compare(EQ, 0);
      IntVector over = IntVector.fromArray(INTS, begins, i);
      VectorMask<Integer> offers = goes;
      for (int v = 0; v < vehicles; v++) {
        IntVector there = IntVector.fromArray(INTS, drawn[2 * v], i),
            back = IntVector.fromArray(INTS, drawn[2 * v + 1], i).add(there);
        over = over.add(back.min(timeout), offers);
        offers = offers.andNot(back.compare(GT, timeout));
        if (missing.areSome) offers = offers.andNot(IntVector.fromArray(INTS, missingOf, i).compare(EQ, v));
      }
      none.blend(over, offers).intoArray(ends, i);
      IntVector more = past.blend(over, goes);
      for (int[] each : latest) {
        IntVector held = IntVector.fromArray(INTS, each, i);
        held.max(more).intoArray(each, i);
        more = held.min(more);
      }
    }
  }

  @Override
  void startRow(int number) {
    row = number;
    draw();
    while (oldest < row && isEmpty(end, oldest & ring - 1)) oldest++;
    if (next - oldest > ring)
      throw new IllegalStateException("more than " + ring + " steps have tasks under way");
    taken.takeAll();
    Arrays.fill(joinedAt, NONE);
    for (int agent = 0; agent < vehicles; agent++) look(agent);
  }

  @Override
  boolean nextBeat() {
    boolean any = false;
    for (int[] each : soonest) any |= isBefore(each, periodGrains);
    if (!any) return false;
    do whose = (whose + 1) % vehicles;
    while (!take(whose));
    return true;
  }

  /** Takes an agent's next offers in worlds where no other agent's offer is earlier. Of offers at equal
   * times, that of the agent with the lower index is first.
   */
  private boolean take(int agent) {
    int[] own = soonest[agent];
    IntVector horizon = IntVector.broadcast(INTS, (1 + rowsAhead) * periodGrains),
        none = IntVector.broadcast(INTS, NONE),
        here = IntVector.broadcast(INTS, row);
    taken.count = 0;
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector time = IntVector.fromArray(INTS, own, i);
      VectorMask<Integer> due = time.compare(LT, horizon);
      for (int other = 0; other < vehicles; other++)
        if (other != agent)
          due = due.and(time.sub(agent < other ? 1 : 0).compare(LT, IntVector.fromArray(INTS, soonest[other], i)));
      none.blend(time, due).intoArray(joinedAt, i);
      if (due.anyTrue()) {
        taken.first[taken.count++] = i;
        IntVector.fromArray(INTS, second[agent], i).intoArray(nextAt, i);
        IntVector.fromArray(INTS, beginOf[agent], i).intoArray(goesOn, i);
        IntVector step = IntVector.fromArray(INTS, stepOf[agent], i);
        step.mul(STEP).intoArray(places, i);
        step.sub(here).mul(STEP).intoArray(beatPlaces, i);
      }
    }
    if (taken.count == 0) return false;
    read(agent);
    look(agent);
    return true;
  }

  /** Recomputes, by drawing their delays again, when the tasks of an agent's offers read each vehicle. */
  private void read(int agent) {
    delays.drawInTurn(taken, places, agent, (long) row * periodGrains, goesOn, drawn);
    for (int v = 0; v < vehicles; v++) {
      int[] there = drawn[2 * v], back = drawn[2 * v + 1];
      for (int k = 0; k < taken.count; k++) {
        int i = taken.first[k];
        IntVector at = IntVector.fromArray(INTS, goesOn, i).add(IntVector.fromArray(INTS, there, i));
        at.intoArray(sampledAt[v], i);
        at.add(IntVector.fromArray(INTS, back, i)).intoArray(goesOn, i);
      }
    }
  }

  /** Finds an agent's next offer in each world of the vectors that were taken. */
  private void look(int agent) {
    int[][] begins = beginAt[agent], ends = end[agent];
    IntVector none = IntVector.broadcast(INTS, NONE), zero = IntVector.broadcast(INTS, 0);
    for (int k = 0; k < taken.count; k++) {
      int i = taken.first[k];
      VectorMask<Integer> gone = IntVector.fromArray(INTS, joinedAt, i).compare(NE, none);
      IntVector last = IntVector.broadcast(INTS, -1).blend(IntVector.fromArray(INTS, stepOf[agent], i), gone);
      IntVector first = zero.add(none), then = zero.add(none), which = zero.add(zero), begun = zero.add(zero);
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
        begun = begun.blend(IntVector.fromArray(INTS, begins[slot], i).add(shift), sooner);
      }
      first.intoArray(soonest[agent], i);
      then.intoArray(second[agent], i);
      which.intoArray(stepOf[agent], i);
      begun.intoArray(beginOf[agent], i);
    }
  }
}
