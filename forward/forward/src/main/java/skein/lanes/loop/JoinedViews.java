package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.NE;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.ArrayList;
import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.LoopTiming;
import skein.forward.TabledDelays;

/** The views of many worlds under the {@code stream} loop, over links on which few views are regular, such as
 * those that lose packets, or where readings may be missing. They are equal to those of {@link LaneViews}, in
 * equal rounds, but computed with SIMD, period by period, as far ahead as the next view of each world needs.
 * The scalar reference is {@code skein.forward.JoiningRun}.
 */
final class JoinedViews {
  private static final int WORLDS = LaneOffers.WORLDS, NONE = LaneOffers.NONE;

  private static final int PAST = -1_000_000_000;

  /** Longest time for which a command can be under way, s; a later view cannot replace its own. */
  private static final double HORIZON_S = 6;

  private static final int EARLY = LaneViews.ROWS_EARLY;

  private final int vehicles, periodGrains, patienceGrains, ahead;

  /** Number of periods within which a world's next view is searched. */
  private final int horizon;

  private final PeriodicRequests requests;

  /** The next period whose events are computed; and, of each vector, the oldest one with pending answers. */
  private int front;

  private final int[] oldest = new int[WORLDS / LANES];

  // By vehicle: of the newest reading, when it was sampled, in grains from the front's begin, the period in
  // which it was requested, and the request's index in the random sequence; and 1 if it is not part of a view
  // yet.
  private final int[][] newestAt, newestSent, newestPlace, isNew;

  // End of the patience, in grains from the front's begin, NONE if no reading waits for others; and 1 after
  // the first view.
  private final int[] patienceEnd = new int[WORLDS], isBegun = new int[WORLDS];

  // Of each world's last view: ViewSource.row; the period in which it is offered, and the round in it.
  private final int[] lastRow = new int[WORLDS],
      lastOffer = new int[WORLDS],
      lastRound = new int[WORLDS];

  /** Times of the views that {@link #settle} joined, in grains from the front's begin, or NONE. */
  private final int[] joinsAt = new int[LANES];

  /** Views of one round. Times are in grains from the begin of the period in which they are offered. */
  final class Round {
    final int[] joinedAt = new int[WORLDS];
    final int[][] sampledAt = new int[vehicles][WORLDS],
        place = new int[vehicles][WORLDS],
        isFresh = new int[vehicles][WORLDS];
  }

  /** The rounds by period, modulo the size, and how many of them are used. */
  private final ArrayList<ArrayList<Round>> rounds = new ArrayList<>();

  private final int[] roundsOf;

  private int row, beat;

  /** The round, and the times of the next views. */
  Round round;

  final int[] nextAt = new int[WORLDS];

  /** @param maxDelayS the longest one-way delay of any link */
  JoinedViews(
      LoopTiming.Stream timing,
      int vehicles,
      double maxDelayS,
      LaneDelays delays,
      MissingReadings missing) {
    this.vehicles = vehicles;
    double periodS = timing.periodS();
    horizon = 2 + (int) Math.ceil(HORIZON_S / periodS);
    ahead = Math.min(LaneViews.MOST_AHEAD, timing.asking().window());
    periodGrains = LaneViews.grains(periodS);
    patienceGrains = LaneViews.grains(timing.patienceS());
    requests = new PeriodicRequests(periodS, timing.asking(), vehicles, maxDelayS, delays, missing);
    newestAt = new int[vehicles][WORLDS];
    newestSent = new int[vehicles][WORLDS];
    newestPlace = new int[vehicles][WORLDS];
    isNew = new int[vehicles][WORLDS];
    roundsOf = new int[Integer.highestOneBit(2 * horizon + 1)];
    while (rounds.size() < roundsOf.length) rounds.add(new ArrayList<>());
  }

  /** Resets to the start of an episode over these links. */
  void start(TabledDelays[] links) {
    requests.start(links);
    front = 0;
    Arrays.fill(oldest, 0);
    Arrays.fill(isBegun, 0);
    Arrays.fill(lastRow, -1);
    Arrays.fill(lastOffer, -1);
    Arrays.fill(patienceEnd, NONE);
    for (int v = 0; v < vehicles; v++) {
      Arrays.fill(newestAt[v], PAST);
      Arrays.fill(newestSent[v], -1);
      Arrays.fill(isNew[v], 0);
    }
  }

  private int slot(int period) {
    return period & roundsOf.length - 1;
  }

  /** Moves to a period; periods are processed in order, from 0. */
  void startRow(int number) {
    row = number;
    beat = -1;
    while (front <= row || front < row + horizon && LaneOffers.isBefore(lastOffer, row + 1)) advance();
  }

  /** Moves to the next round of the period, if it has one. */
  boolean nextBeat() {
    if (++beat >= roundsOf[slot(row)]) return false;
    round = rounds.get(slot(row)).get(beat);
    Arrays.fill(nextAt, NONE);
    boolean isKnown = beat + 1 < roundsOf[slot(row)] && find(row, beat + 1);
    for (int next = row + 1; !isKnown && next < front; next++)
      for (int n = 0; n < roundsOf[slot(next)]; n++) isKnown = find(next, n);
    return true;
  }

  /** Notes the times of a later round's views, in worlds for which no earlier one was found.
   *
   * @return whether all worlds with a view in the present round have a next one now
   */
  private boolean find(int period, int number) {
    int[] joinedAt = round.joinedAt, later = rounds.get(slot(period)).get(number).joinedAt;
    int shift = (period - row) * periodGrains;
    boolean isKnown = true;
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector next = IntVector.fromArray(INTS, nextAt, i), at = IntVector.fromArray(INTS, later, i);
      VectorMask<Integer> isOpen = next.compare(EQ, NONE), found = isOpen.and(at.compare(LT, NONE));
      next.blend(at.add(shift), found).intoArray(nextAt, i);
      isKnown &=
          !isOpen.andNot(found).and(IntVector.fromArray(INTS, joinedAt, i).compare(LT, NONE)).anyTrue();
    }
    return isKnown;
  }

  private void advance() {
    roundsOf[slot(front)] = 0;
    requests.ask(front);
    for (int i = 0; i < WORLDS; i += LANES) {
      int vector = i / LANES;
      while (oldest[vector] < front && !isPending(i, oldest[vector])) oldest[vector]++;
      while (settle(i)) {
        offer(i);
        add(i);
      }
    }
    IntVector past = IntVector.broadcast(INTS, PAST), none = IntVector.broadcast(INTS, NONE);
    for (int i = 0; i < WORLDS; i += LANES) {
      for (int v = 0; v < vehicles; v++)
        IntVector.fromArray(INTS, newestAt[v], i).sub(periodGrains).max(past).intoArray(newestAt[v], i);
      IntVector end = IntVector.fromArray(INTS, patienceEnd, i);
      end.sub(periodGrains, end.compare(LT, none)).intoArray(patienceEnd, i);
    }
    front++;
  }

  /** Whether a period's requests have answers that are newer than the newest readings. */
  private boolean isPending(int i, int step) {
    int slot = requests.slot(step), shift = (step - front) * periodGrains;
    for (int v = 0; v < vehicles; v++)
      if (IntVector.fromArray(INTS, requests.answered[v][slot], i)
          .compare(NE, NONE)
          .and(
              IntVector.fromArray(INTS, requests.read[v][slot], i)
                  .add(shift)
                  .compare(GT, IntVector.fromArray(INTS, newestAt[v], i)))
          .anyTrue()) return true;
    return false;
  }

  /** Takes the answers of a vector's worlds up to the next view, or to the front's end; sets {@link #joinsAt}.
   *
   * @return whether some world has such a view
   */
  private boolean settle(int i) {
    int from = oldest[i / LANES];
    IntVector period = IntVector.broadcast(INTS, periodGrains),
        none = IntVector.broadcast(INTS, NONE);
    // The first newer answer of any vehicle; and the answer by which all vehicles have one.
    IntVector first = period,
        whole = IntVector.broadcast(INTS, PAST),
        wholeMade = whole,
        wholeOf = IntVector.broadcast(INTS, -1);
    for (int v = 0; v < vehicles; v++) {
      int[][] answered = requests.answered[v], read = requests.read[v];
      IntVector newest = IntVector.fromArray(INTS, newestAt[v], i), next = period, made = newest;
      for (int step = from; step <= front; step++) {
        int slot = requests.slot(step), shift = (step - front) * periodGrains;
        // No overflow, because the shift is not positive.
        IntVector answer = IntVector.fromArray(INTS, answered[slot], i).add(shift),
            reading = IntVector.fromArray(INTS, read[slot], i).add(shift);
        VectorMask<Integer> sooner = answer.compare(LT, next).and(reading.compare(GT, newest));
        next = next.blend(answer, sooner);
        made = made.blend(reading, sooner);
      }
      first = first.min(next);
      VectorMask<Integer> later =
          next.compare(GT, whole)
              .or(next.compare(EQ, whole).and(made.compare(GE, wholeMade)))
              .and(IntVector.fromArray(INTS, isNew[v], i).compare(EQ, 0));
      whole = whole.blend(next, later);
      wholeMade = wholeMade.blend(made, later);
      wholeOf = wholeOf.blend(v, later);
    }
    IntVector end = IntVector.fromArray(INTS, patienceEnd, i), begun = IntVector.fromArray(INTS, isBegun, i);
    end =
        end.blend(
            first.add(patienceGrains),
            end.compare(EQ, none).and(begun.compare(NE, 0)).and(first.compare(LT, period)));
    IntVector at = whole.min(end);
    VectorMask<Integer> joins = at.compare(LT, period);
    // Of answers in one moment, that of the earlier sample is first. The end of the patience is first, too, if
    // the sample is later than the first answer.
    IntVector begin = end.sub(patienceGrains);
    VectorMask<Integer> isWhole =
        whole.compare(LT, end).or(whole.compare(EQ, end).and(wholeMade.compare(LT, begin)));
    IntVector until = period.blend(at, joins),
        untilMade =
            IntVector.broadcast(INTS, Integer.MIN_VALUE).blend(begin.blend(wholeMade, isWhole), joins),
        untilOf = wholeOf.blend(-1, isWhole.not());
    for (int v = 0; v < vehicles; v++) {
      int[][] answered = requests.answered[v], read = requests.read[v];
      IntVector before = IntVector.fromArray(INTS, newestAt[v], i),
          newest = before,
          place = IntVector.fromArray(INTS, newestPlace[v], i),
          sent = IntVector.fromArray(INTS, newestSent[v], i),
          beyond = untilMade.add(1, untilOf.compare(GE, v));
      for (int step = from; step <= front; step++) {
        int slot = requests.slot(step), shift = (step - front) * periodGrains;
        IntVector answer = IntVector.fromArray(INTS, answered[slot], i).add(shift),
            reading = IntVector.fromArray(INTS, read[slot], i).add(shift);
        VectorMask<Integer> takes =
            answer
                .compare(LT, until)
                .or(answer.compare(EQ, until).and(reading.compare(LT, beyond)))
                .and(reading.compare(GT, newest));
        if (takes.anyTrue()) {
          newest = newest.blend(reading, takes);
          place = place.blend(IntVector.fromArray(INTS, requests.places[v][slot], i), takes);
          sent = sent.blend(IntVector.fromArray(INTS, requests.sentIn[v][slot], i), takes);
        }
      }
      newest.intoArray(newestAt[v], i);
      place.intoArray(newestPlace[v], i);
      sent.intoArray(newestSent[v], i);
      IntVector.fromArray(INTS, isNew[v], i).blend(1, newest.compare(NE, before)).intoArray(isNew[v], i);
    }
    begun.blend(1, joins).intoArray(isBegun, i);
    end.blend(none, joins).intoArray(patienceEnd, i);
    none.blend(at, joins).intoArray(joinsAt, 0);
    return joins.anyTrue();
  }

  /** Determines the period and the round in which each joined view is offered, as {@link LaneViews} does. */
  private void offer(int i) {
    VectorMask<Integer> joins = IntVector.fromArray(INTS, joinsAt, 0).compare(LT, NONE);
    IntVector last = IntVector.fromArray(INTS, lastRow, i),
        before = IntVector.fromArray(INTS, lastOffer, i),
        number = IntVector.fromArray(INTS, lastRound, i),
        sent = last;
    for (int v = 0; v < vehicles; v++) sent = sent.max(IntVector.fromArray(INTS, newestSent[v], i));
    last.blend(sent, joins).intoArray(lastRow, i);
    number
        .blend(number.add(1).blend(0, sent.compare(NE, before)), joins)
        .intoArray(lastRound, i);
    VectorMask<Integer> early = joins.and(before.compare(LT, sent.sub(EARLY))), mayStay = early;
    IntVector begin = sent.sub(front).mul(periodGrains);
    for (int v = 0; v < vehicles; v++)
      mayStay =
          mayStay
              .and(IntVector.fromArray(INTS, newestSent[v], i).compare(EQ, sent))
              .and(IntVector.fromArray(INTS, newestAt[v], i).sub(begin).compare(LT, periodGrains));
    before.blend(sent, joins).sub(EARLY, early).intoArray(lastOffer, i);
    for (long open = mayStay.toLong(); open != 0; open &= open - 1) {
      int lane = Long.numberOfTrailingZeros(open), world = i + lane;
      if (isRegular(world, lastRow[world], joinsAt[lane])) lastOffer[world] += EARLY;
    }
  }

  /** See {@link ViewSource#isRegular}; all requests were sent and read within the period. */
  private boolean isRegular(int world, int row, int at) {
    int begin = (row - front) * periodGrains, place = LaneDelays.placeOf(row);
    if (at >= begin + ahead * periodGrains) return false;
    for (int v = 0; v < vehicles; v++) {
      if (newestPlace[v][world] != place) return false;
      for (int step = row - 1; step >= 0 && step > front - requests.ring; step--)
        if (end(world, v, step) > at) return false;
      for (int step = row + 1; step <= front; step++)
        if (requests.asked[v][requests.slot(step)][world] != 0 || end(world, v, step) <= at) return false;
    }
    return true;
  }

  private int end(int world, int vehicle, int step) {
    return requests.ends[vehicle][requests.slot(step)][world] + (step - front) * periodGrains;
  }

  private void add(int i) {
    IntVector at = IntVector.fromArray(INTS, joinsAt, 0),
        offers = IntVector.fromArray(INTS, lastOffer, i),
        numbers = IntVector.fromArray(INTS, lastRound, i),
        zero = IntVector.broadcast(INTS, 0);
    VectorMask<Integer> open = at.compare(LT, NONE);
    while (open.anyTrue()) {
      int world = i + Long.numberOfTrailingZeros(open.toLong()), period = lastOffer[world];
      Round round = roundOf(period, lastRound[world]);
      VectorMask<Integer> these = offers.compare(EQ, period).and(numbers.compare(EQ, lastRound[world])).and(open);
      int shift = (front - period) * periodGrains, place = LaneDelays.placeOf(period);
      at.add(shift).intoArray(round.joinedAt, i, these);
      for (int v = 0; v < vehicles; v++) {
        IntVector fresh = IntVector.fromArray(INTS, isNew[v], i);
        IntVector.fromArray(INTS, newestAt[v], i).add(shift).intoArray(round.sampledAt[v], i, these);
        IntVector.fromArray(INTS, newestPlace[v], i).sub(place).intoArray(round.place[v], i, these);
        fresh.intoArray(round.isFresh[v], i, these);
        fresh.blend(zero, these).intoArray(isNew[v], i);
      }
      open = open.andNot(these);
    }
  }

  private Round roundOf(int period, int number) {
    ArrayList<Round> rounds = this.rounds.get(slot(period));
    if (rounds.size() == number) rounds.add(new Round());
    Round round = rounds.get(number);
    if (number == roundsOf[slot(period)]) {
      roundsOf[slot(period)]++;
      Arrays.fill(round.joinedAt, NONE);
      for (int[] each : round.isFresh) Arrays.fill(each, 0);
    }
    return round;
  }
}
