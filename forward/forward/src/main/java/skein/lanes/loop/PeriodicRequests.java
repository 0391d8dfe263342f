package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.ASHR;
import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LSHL;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.NE;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.Asking;
import skein.forward.Delays;
import skein.forward.TabledDelays;

/** One request a period to every vehicle, in many worlds. If n requests are unanswered, where n is the window,
 * a request waits until one of them ends. A request that becomes due meanwhile is missed. Of events in one
 * nanosecond, the one that was scheduled first is first, and time-outs are last, as in {@code Rollout}.
 */
final class PeriodicRequests {
  private static final int WORLDS = LaneOffers.WORLDS, NONE = LaneOffers.NONE;

  private static final int STEP = LaneDelays.placeOf(1);

  private static final int PAST = -1_000_000_000;

  private static final LaneVectors ALL = LaneVectors.all();

  private final LaneDelays delays;
  private final MissingReadings missing;
  private final int periodGrains, timeoutGrains, window;

  /** Number of periods that are stored, a power of two: enough for a request that waits and then times
   * out. */
  final int ring;

  /** Whether a request may have to wait, on at least one link. */
  private boolean mayWait;

  // By vehicle: index of the next request in the random sequence, begin of the last request, and the latest
  // ends of all requests, the latest first. Each is twice the time from the period's start, plus 1 for events
  // that come after a request due at that moment: time-outs, and events that were not known when it was
  // scheduled, one period before.
  private final int[][] next, began;
  private final int[][][] latest;

  /** By vehicle and {@link #slot}: times of request, reading and answer, from the start of the period. The
   * answer is {@link LaneOffers#NONE} if there is none.
   */
  final int[][][] asked, read, answered;

  /** By vehicle and {@link #slot}: index of the request in the random sequence; the period in which it is
   * sent, from which it may have waited; and when it ends, past if it was missed.
   */
  final int[][][] places, sentIn, ends;

  private final int[] there = new int[WORLDS], back = new int[WORLDS];

  /** @param maxDelayS the longest one-way delay of any link */
  PeriodicRequests(
      double periodS,
      Asking asking,
      int vehicles,
      double maxDelayS,
      LaneDelays delays,
      MissingReadings missing) {
    this.missing = missing;
    this.delays = delays;
    periodGrains = LaneViews.grains(periodS);
    timeoutGrains = LaneViews.grains(asking.timeoutS());
    window = asking.window();
    int longest = Math.min(timeoutGrains, 2 * LaneViews.grains(maxDelayS) + 2);
    ring = Integer.highestOneBit(2 * (2 * longest / periodGrains + 3) - 1);
    next = new int[vehicles][WORLDS];
    began = new int[vehicles][WORLDS];
    latest = new int[vehicles][window][WORLDS];
    asked = new int[vehicles][ring][WORLDS];
    read = new int[vehicles][ring][WORLDS];
    answered = new int[vehicles][ring][WORLDS];
    places = new int[vehicles][ring][WORLDS];
    ends = new int[vehicles][ring][WORLDS];
    sentIn = new int[vehicles][ring][WORLDS];
  }

  /** Resets to the start of an episode over these links. */
  void start(TabledDelays[] links) {
    mayWait = false;
    for (TabledDelays link : links)
      mayWait |= 2 * LaneViews.grains(link.maxS()) + 2 >= (long) window * periodGrains;
    for (int v = 0; v < next.length; v++) {
      Arrays.fill(next[v], 0);
      Arrays.fill(began[v], PAST);
      for (int[] each : latest[v]) Arrays.fill(each, PAST);
    }
  }

  int slot(int period) {
    return period & ring - 1;
  }

  /** Computes the requests of a period; periods are processed in order, from 0. */
  void ask(int period) {
    for (int v = 0; v < next.length; v++) ask(v, period);
  }

  private void ask(int vehicle, int period) {
    int slot = slot(period), line = Delays.question(0, vehicle);
    int[] asks = asked[vehicle][slot], reads = read[vehicle][slot], answers = answered[vehicle][slot];
    int[] at = places[vehicle][slot], end = ends[vehicle][slot];
    Arrays.fill(sentIn[vehicle][slot], period);
    if (mayWait) {
      await(vehicle, period, asks, answers, sentIn[vehicle][slot]);
      System.arraycopy(next[vehicle], 0, at, 0, WORLDS);
    } else {
      Arrays.fill(asks, 0);
      Arrays.fill(answers, 0);
      Arrays.fill(at, LaneDelays.placeOf(period));
    }
    long begin = (long) period * periodGrains;
    delays.draw(ALL, at, line, begin, asks, there);
    System.arraycopy(asks, 0, reads, 0, WORLDS);
    LaneDelays.add(ALL, there, reads);
    delays.draw(ALL, at, line + 1, begin, reads, back);
    if (mayWait) goOn(vehicle, asks, answers);
    IntVector none = IntVector.broadcast(INTS, NONE),
        past = IntVector.broadcast(INTS, PAST),
        timeout = IntVector.broadcast(INTS, timeoutGrains);
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector from = IntVector.fromArray(INTS, asks, i),
          to = IntVector.fromArray(INTS, there, i),
          roundTrip = IntVector.fromArray(INTS, back, i).add(to);
      VectorMask<Integer> goes = IntVector.fromArray(INTS, answers, i).compare(NE, none),
          comes = roundTrip.compare(LE, timeout).and(goes);
      IntVector answer = from.add(roundTrip);
      none.blend(answer, comes).intoArray(answers, i);
      // A time-out comes after all else of its moment.
      past.blend(from.add(timeoutGrains + 1), goes).blend(answer, comes).intoArray(end, i);
    }
    if (missing.areSome) missing.replace(vehicle, begin, reads, answers, NONE);
  }

  /** Computes when the request is sent. A missed request has no answer. */
  private void await(int vehicle, int period, int[] asked, int[] answers, int[] sentIn) {
    int[] begun = began[vehicle], lastOf = latest[vehicle][window - 1];
    IntVector none = IntVector.broadcast(INTS, NONE),
        past = IntVector.broadcast(INTS, PAST),
        zero = IntVector.broadcast(INTS, 0),
        twice = IntVector.broadcast(INTS, period == 0 ? 0 : 2 * periodGrains);
    for (int i = 0; i < WORLDS; i += LANES) {
      for (int[] each : latest[vehicle])
        IntVector.fromArray(INTS, each, i).sub(twice).max(past).intoArray(each, i);
      IntVector before = IntVector.fromArray(INTS, begun, i).sub(twice).max(past);
      VectorMask<Integer> goes = before.compare(LE, zero);
      IntVector begin = IntVector.fromArray(INTS, lastOf, i).max(zero);
      before.blend(begin, goes).intoArray(begun, i);
      IntVector asks = begin.lanewise(ASHR, 1), next = IntVector.broadcast(INTS, periodGrains);
      asks.intoArray(asked, i);
      for (; asks.compare(GE, next).anyTrue(); next = next.add(periodGrains))
        IntVector.fromArray(INTS, sentIn, i).add(1, asks.compare(GE, next)).intoArray(sentIn, i);
      none.blend(zero, goes).intoArray(answers, i);
    }
  }

  /** Computes when the request ends, in worlds where it is sent. */
  private void goOn(int vehicle, int[] asked, int[] answers) {
    int[] places = next[vehicle];
    IntVector none = IntVector.broadcast(INTS, NONE),
        past = IntVector.broadcast(INTS, PAST),
        period = IntVector.broadcast(INTS, periodGrains),
        timeout = IntVector.broadcast(INTS, timeoutGrains);
    for (int i = 0; i < WORLDS; i += LANES) {
      VectorMask<Integer> goes = IntVector.fromArray(INTS, answers, i).compare(NE, none);
      IntVector.fromArray(INTS, places, i).add(STEP, goes).intoArray(places, i);
      IntVector asks = IntVector.fromArray(INTS, asked, i);
      IntVector to = IntVector.fromArray(INTS, there, i), back = IntVector.fromArray(INTS, this.back, i);
      IntVector roundTrip = to.add(back), lasts = roundTrip.min(timeout);
      // An answer's time is known from the moment the request reaches the vehicle.
      VectorMask<Integer> isBehind = back.compare(LT, period).or(roundTrip.compare(GT, timeout));
      IntVector ends = asks.add(lasts).lanewise(LSHL, 1).add(1, isBehind);
      IntVector more = past.blend(ends, goes);
      for (int[] each : latest[vehicle]) {
        IntVector held = IntVector.fromArray(INTS, each, i);
        held.max(more).intoArray(each, i);
        more = held.min(more);
      }
    }
  }
}
