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

/** The rounds of the {@code sequential} loop: the vehicles are read in sequence, and at the last answer all
 * vehicles are offered the readings. A round with a failed request offers nothing.
 */
final class SequentialOffers extends LaneOffers {
  private static final int STEP = LaneDelays.placeOf(1);

  /** Maximum difference between two worlds in the progress of their rounds, s. */
  private static final double AHEAD_S = 0.5;

  /** Maximum time within which the next successful round is searched, in grains. */
  private static final int HORIZON = LaneViews.grains(4);

  private final int periodGrains, timeoutGrains;

  // The next round: its begin, and its indices in the random sequences.
  private final int[] tick = new int[WORLDS], tickPlace = new int[WORLDS];

  // The next two successful rounds of each world: their ends, the times of the readings, and the indices in
  // the random sequence.
  private final int[] end = new int[WORLDS], laterEnd = new int[WORLDS];
  private final int[][] read, laterRead;
  private final int[] places = new int[WORLDS], laterPlaces = new int[WORLDS];

  /** For each vehicle, the delay of its request, then of its answer. */
  private final int[][] drawn;

  /** The vehicle that has no reading for the round, if readings may be missing. */
  private final int[] missingOf = new int[WORLDS];

  private final int[] beatPlaces = new int[WORLDS];
  private int row;

  /** Vectors in which some world needs its next round. */
  private final LaneVectors searching = new LaneVectors();

  SequentialOffers(LoopTiming.Sequential timing, int vehicles, MissingReadings missing) {
    super(vehicles, new LaneDelays(), missing, true, (int) (AHEAD_S / timing.periodS()));
    read = new int[vehicles][WORLDS];
    laterRead = new int[vehicles][WORLDS];
    drawn = new int[2 * vehicles][WORLDS];
    periodGrains = LaneViews.grains(timing.periodS());
    timeoutGrains = LaneViews.grains(timing.asking().timeoutS());
    keepOffers(beatPlaces);
  }

  @Override
  void start(int[] worldKeys, TabledDelays[] links) {
    delays.start(worldKeys, links);
    Arrays.fill(tick, 0);
    Arrays.fill(tickPlace, 0);
    row = 0;
    Arrays.fill(end, NONE);
    Arrays.fill(laterEnd, NONE);
    find();
  }

  @Override
  void startRow(int number) {
    row = number;
    if (row > 0) {
      IntVector period = IntVector.broadcast(INTS, periodGrains), none = IntVector.broadcast(INTS, NONE);
      for (int i = 0; i < WORLDS; i += LANES) {
        IntVector.fromArray(INTS, tick, i).sub(period).intoArray(tick, i);
        for (int[] each : new int[][] {end, laterEnd}) {
          IntVector time = IntVector.fromArray(INTS, each, i);
          time.sub(period, time.compare(NE, none)).intoArray(each, i);
        }
        for (int[][] reads : new int[][][] {read, laterRead})
          for (int[] each : reads) IntVector.fromArray(INTS, each, i).sub(period).intoArray(each, i);
      }
      find();
    }
  }

  @Override
  boolean nextBeat() {
    if (!isBefore(end, periodGrains)) return false;
    IntVector horizon = IntVector.broadcast(INTS, (1 + rowsAhead) * periodGrains),
        none = IntVector.broadcast(INTS, NONE),
        here = IntVector.broadcast(INTS, LaneDelays.placeOf(row));
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector ends = IntVector.fromArray(INTS, end, i);
      VectorMask<Integer> due = ends.compare(LT, horizon);
      none.blend(ends, due).intoArray(joinedAt, i);
      IntVector.fromArray(INTS, laterEnd, i).intoArray(nextAt, i);
      for (int v = 0; v < vehicles; v++) IntVector.fromArray(INTS, read[v], i).intoArray(sampledAt[v], i);
      IntVector.fromArray(INTS, places, i).sub(here).intoArray(beatPlaces, i);
      ends.blend(none, due).intoArray(end, i);
    }
    find();
    return true;
  }

  /** Computes the next two successful rounds of each world. */
  private void find() {
    while (shift()) {
      delays.drawInTurn(searching, tickPlace, 0, (long) row * periodGrains, tick, drawn);
      if (missing.areSome) missing.find(searching, tick, (long) row * periodGrains, drawn, missingOf);
      flyRound();
    }
  }

  /** Makes the second round the next one in worlds whose next round has ended.
   *
   * @return whether some world needs another round
   */
  private boolean shift() {
    IntVector none = IntVector.broadcast(INTS, NONE), horizon = IntVector.broadcast(INTS, HORIZON);
    searching.count = 0;
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector ends = IntVector.fromArray(INTS, end, i),
          later = IntVector.fromArray(INTS, laterEnd, i);
      VectorMask<Integer> over = ends.compare(EQ, none);
      if (over.anyTrue()) {
        ends.blend(later, over).intoArray(end, i);
        later = later.blend(NONE, over);
        later.intoArray(laterEnd, i);
        for (int v = 0; v < vehicles; v++)
          IntVector.fromArray(INTS, read[v], i)
              .blend(IntVector.fromArray(INTS, laterRead[v], i), over)
              .intoArray(read[v], i);
        IntVector.fromArray(INTS, places, i)
            .blend(IntVector.fromArray(INTS, laterPlaces, i), over)
            .intoArray(places, i);
      }
      if (later.compare(EQ, none).and(IntVector.fromArray(INTS, tick, i).compare(LT, horizon)).anyTrue())
        searching.first[searching.count++] = i;
    }
    return searching.count > 0;
  }

  /** Simulates one more round in worlds that need one. */
  private void flyRound() {
    IntVector none = IntVector.broadcast(INTS, NONE),
        horizon = IntVector.broadcast(INTS, HORIZON),
        timeout = IntVector.broadcast(INTS, timeoutGrains),
        period = IntVector.broadcast(INTS, periodGrains),
        step = IntVector.broadcast(INTS, STEP);
    for (int k = 0; k < searching.count; k++) {
      int i = searching.first[k];
      IntVector later = IntVector.fromArray(INTS, laterEnd, i),
          begin = IntVector.fromArray(INTS, tick, i),
          at = IntVector.fromArray(INTS, tickPlace, i);
      VectorMask<Integer> searches = later.compare(EQ, none).and(begin.compare(LT, horizon));
      IntVector over = begin;
      VectorMask<Integer> found = searches;
      for (int v = 0; v < vehicles; v++) {
        IntVector there = IntVector.fromArray(INTS, drawn[2 * v], i),
            back = IntVector.fromArray(INTS, drawn[2 * v + 1], i).add(there);
        // A failed request ends its round; a later round overwrites its readings.
        IntVector.fromArray(INTS, laterRead[v], i).blend(over.add(there), found).intoArray(laterRead[v], i);
        over = over.add(back.min(timeout), found);
        found = found.andNot(back.compare(GT, timeout));
        if (missing.areSome) found = found.andNot(IntVector.fromArray(INTS, missingOf, i).compare(EQ, v));
      }
      later.blend(over, found).intoArray(laterEnd, i);
      IntVector.fromArray(INTS, laterPlaces, i).blend(at, found).intoArray(laterPlaces, i);
      begin.blend(over.add(period), searches).intoArray(tick, i);
      at.add(step, searches).intoArray(tickPlace, i);
    }
  }
}
