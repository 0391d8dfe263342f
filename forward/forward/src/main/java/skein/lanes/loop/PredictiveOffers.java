package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.ASHR;
import static jdk.incubator.vector.VectorOperators.EQ;
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
import skein.forward.Delays;
import skein.forward.LoopTiming;
import skein.forward.TabledDelays;

/** The {@code predictive} loop: every vehicle is read once a period, and half-way between two requests all
 * vehicles are offered what is known at that time. Answers enter a {@link LaneForecast} in the order of their
 * arrival.
 *
 * <p>If n requests are unanswered, where n is the window, a request waits until one of them ends. A request
 * that becomes due meanwhile is missed. Of events in one nanosecond, the one that was scheduled first is
 * first, and time-outs are last, as in {@code Rollout}.
 */
final class PredictiveOffers extends LaneOffers {
  private static final int STEP = LaneDelays.placeOf(1);

  private static final int PAST = -1_000_000_000;

  private static final LaneVectors ALL = LaneVectors.all();

  private final LaneForecast forecast;
  private final int periodGrains, timeoutGrains, due, window;

  /** Number of periods that are stored, a power of two: enough for a request that waits and then times
   * out. */
  private final int ring;

  /** Whether a request may have to wait, on at least one link. */
  private boolean mayWait;

  // By vehicle: index of the next request in the random sequence, begin of the last request, and the latest
  // ends of all requests, the latest first. Each is twice the time from the period's start, plus 1 for events
  // that come after a request due at that moment: time-outs, and events that were not known when it was
  // scheduled, one period before.
  private final int[][] places, began;
  private final int[][][] latest;

  // By vehicle and period modulo ring: times of request, reading and answer, from the start of the period.
  // The answer is NONE if there is none, or if it was taken.
  private final int[][][] asked, read, answered;

  private final int[] there = new int[WORLDS], back = new int[WORLDS];

  /** The oldest period whose requests may have pending answers. */
  private int oldest;

  private int row;

  // The taken answers: their code, from period and vehicle; the vehicle; and the times of request, reading
  // and answer.
  private final int[] found = new int[WORLDS],
      whose = new int[WORLDS],
      askedAt = new int[WORLDS],
      madeAt = new int[WORLDS],
      receivedAt = new int[WORLDS];

  /** Vectors in which some world may have pending answers. */
  private final LaneVectors searching = new LaneVectors();

  private boolean more;

  /** @param maxDelayS the longest one-way delay of any link */
  PredictiveOffers(
      LoopTiming.Predictive timing,
      int vehicles,
      double maxDelayS,
      LaneForecast forecast,
      MissingReadings missing) {
    super(vehicles, new LaneDelays(), missing, true, 0);
    this.forecast = forecast;
    double periodS = timing.periodS();
    periodGrains = LaneViews.grains(periodS);
    timeoutGrains = LaneViews.grains(timing.asking().timeoutS());
    due = forecast.dueGrains;
    window = timing.asking().window();
    int longest = Math.min(timeoutGrains, 2 * LaneViews.grains(maxDelayS) + 2);
    ring = Integer.highestOneBit(2 * (2 * longest / periodGrains + 3) - 1);
    places = new int[vehicles][WORLDS];
    began = new int[vehicles][WORLDS];
    latest = new int[vehicles][window][WORLDS];
    asked = new int[vehicles][ring][WORLDS];
    read = new int[vehicles][ring][WORLDS];
    answered = new int[vehicles][ring][WORLDS];
    keepOffers(new int[WORLDS]);
    Arrays.fill(nextAt, due + periodGrains);
    for (int v = 0; v < vehicles; v++) fresh[v] = forecast.track(v).fresh;
  }

  @Override
  void start(int[] worldKeys, TabledDelays[] links) {
    delays.start(worldKeys, links);
    mayWait = false;
    for (TabledDelays link : links)
      mayWait |= 2 * LaneViews.grains(link.maxS()) + 2 >= (long) window * periodGrains;
    for (int v = 0; v < vehicles; v++) {
      Arrays.fill(places[v], 0);
      Arrays.fill(began[v], PAST);
      for (int[] each : latest[v]) Arrays.fill(each, PAST);
    }
    forecast.start();
    oldest = 0;
  }

  @Override
  void startRow(int number) {
    row = number;
    forecast.startRow(row);
    for (int v = 0; v < vehicles; v++) ask(v);
    searching.takeAll();
    Arrays.fill(found, -1);
    while (take()) forecast.enter(searching, whose, askedAt, madeAt, receivedAt);
    while (oldest < row && isEmpty(answered, oldest & ring - 1)) oldest++;
    forecast.tell(joinedAt, sampledAt);
    more = true;
  }

  @Override
  boolean nextBeat() {
    boolean first = more;
    more = false;
    return first;
  }

  private void ask(int vehicle) {
    int slot = row & ring - 1, line = Delays.question(0, vehicle);
    int[] asks = asked[vehicle][slot], reads = read[vehicle][slot], answers = answered[vehicle][slot];
    if (mayWait) await(vehicle, asks, answers);
    else {
      Arrays.fill(asks, 0);
      Arrays.fill(answers, 0);
      Arrays.fill(places[vehicle], LaneDelays.placeOf(row));
    }
    long begin = (long) row * periodGrains;
    delays.draw(ALL, places[vehicle], line, begin, asks, there);
    System.arraycopy(asks, 0, reads, 0, WORLDS);
    LaneDelays.add(ALL, there, reads);
    delays.draw(ALL, places[vehicle], line + 1, begin, reads, back);
    if (mayWait) goOn(vehicle, asks, answers);
    IntVector none = IntVector.broadcast(INTS, NONE), timeout = IntVector.broadcast(INTS, timeoutGrains);
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector at = IntVector.fromArray(INTS, asks, i),
          to = IntVector.fromArray(INTS, there, i),
          roundTrip = IntVector.fromArray(INTS, back, i).add(to);
      VectorMask<Integer> comes =
          roundTrip.compare(LE, timeout).and(IntVector.fromArray(INTS, answers, i).compare(NE, none));
      none.blend(at.add(roundTrip), comes).intoArray(answers, i);
    }
    if (missing.areSome) missing.replace(vehicle, begin, reads, answers, NONE);
  }

  /** Computes when the request is sent. A missed request has no answer. */
  private void await(int vehicle, int[] asked, int[] answers) {
    int[] begun = began[vehicle], lastOf = latest[vehicle][window - 1];
    IntVector none = IntVector.broadcast(INTS, NONE),
        past = IntVector.broadcast(INTS, PAST),
        zero = IntVector.broadcast(INTS, 0),
        twice = IntVector.broadcast(INTS, row == 0 ? 0 : 2 * periodGrains);
    for (int i = 0; i < WORLDS; i += LANES) {
      for (int[] each : latest[vehicle])
        IntVector.fromArray(INTS, each, i).sub(twice).max(past).intoArray(each, i);
      IntVector before = IntVector.fromArray(INTS, begun, i).sub(twice).max(past);
      VectorMask<Integer> goes = before.compare(LE, zero);
      IntVector begin = IntVector.fromArray(INTS, lastOf, i).max(zero);
      before.blend(begin, goes).intoArray(begun, i);
      begin.lanewise(ASHR, 1).intoArray(asked, i);
      none.blend(zero, goes).intoArray(answers, i);
    }
  }

  /** Computes when the request ends, in worlds where it is sent. */
  private void goOn(int vehicle, int[] asked, int[] answers) {
    int[] places = this.places[vehicle];
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

  /** Takes the next answer of each world that arrives before the decision is due.
   *
   * @return whether there was one
   */
  private boolean take() {
    IntVector none = IntVector.broadcast(INTS, NONE),
        known = IntVector.broadcast(INTS, due),
        beyond = IntVector.broadcast(INTS, due + 1),
        no = IntVector.broadcast(INTS, -1),
        within = IntVector.broadcast(INTS, due - periodGrains);
    int kept = 0;
    for (int k = 0; k < searching.count; k++) {
      int i = searching.first[k];
      IntVector taken = IntVector.fromArray(INTS, found, i);
      no.intoArray(found, i);
      no.intoArray(whose, i);
      beyond.intoArray(receivedAt, i);
      boolean any = false;
      for (int step = oldest; step <= row; step++) {
        int slot = step & ring - 1, shift = (step - row) * periodGrains;
        for (int v = 0; v < vehicles; v++) {
          int code = step * vehicles + v;
          int[] answers = answered[v][slot];
          IntVector answer = IntVector.fromArray(INTS, answers, i);
          answer = answer.blend(none, taken.compare(EQ, code));
          answer.intoArray(answers, i);
          // No overflow, because the shift is not positive.
          answer = answer.add(shift);
          IntVector first = IntVector.fromArray(INTS, receivedAt, i);
          VectorMask<Integer> sooner = answer.compare(LT, first);
          if (sooner.anyTrue()) {
            IntVector made = IntVector.fromArray(INTS, read[v][slot], i).add(shift);
            sooner = sooner.andNot(answer.compare(EQ, known).andNot(made.compare(LT, within)));
            any |= sooner.anyTrue();
            first.blend(answer, sooner).intoArray(receivedAt, i);
            IntVector.fromArray(INTS, found, i).blend(code, sooner).intoArray(found, i);
            IntVector.fromArray(INTS, whose, i).blend(v, sooner).intoArray(whose, i);
            IntVector.fromArray(INTS, madeAt, i).blend(made, sooner).intoArray(madeAt, i);
            IntVector.fromArray(INTS, askedAt, i)
                .blend(IntVector.fromArray(INTS, asked[v][slot], i).add(shift), sooner)
                .intoArray(askedAt, i);
          }
        }
      }
      if (any) searching.first[kept++] = i;
    }
    searching.count = kept;
    return kept > 0;
  }
}
