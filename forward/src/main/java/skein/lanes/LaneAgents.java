package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;
import skein.forward.Duelist;
import skein.forward.Rollout;
import skein.forward.Steering;

/**
 * The vehicles of one role in many worlds, and their controllers, as {@code skein.flow.Pace} and
 * {@code skein.flow.Steer} let them: when each decides upon what it was offered, and when its command
 * acts. Times are in grains of 4 ns from the period's begin.
 */
final class LaneAgents {
  private static final int WORLDS = LanePolicy.WORLDS, NONE = LaneOffers.NONE;

  /** In the place of the time since the last decision, s: it never decided. */
  private static final float LONG_AGO = 1e9f;

  /** Times count no longer ago than this. */
  private static final int LONG_PAST = -1_000_000_000;

  final LaneFlights flights;
  final LanePolicy policy;
  private final int self, line, periodGrains, intervalGrains, handoverGrains, deadGrains;
  private final float startHeading, periodS;
  private final boolean decidesFirst;

  // When it may be commanded again, when the last command reaches it, and when that was sent.
  private final int[] ready = new int[WORLDS], reaches = new int[WORLDS], sentAt = new int[WORLDS];

  // When it decides, and when it sends; NONE where it does not. When the command acts.
  private final int[] decides = new int[WORLDS], sends = new int[WORLDS], acts = new int[WORLDS];

  /** How long before the period's begin it decided, s. */
  private final float[] decidedBefore = new float[WORLDS];

  private final int[] places = new int[WORLDS], there = new int[WORLDS], back = new int[WORLDS];
  private final LaneObservation sight = new LaneObservation();

  /** What was sent last and before that, what was decided last, and what is now. */
  final Directions sent = new Directions(WORLDS), sentBefore = new Directions(WORLDS);

  private final Directions known = new Directions(WORLDS),
      decided = new Directions(WORLDS),
      decidedNow = new Directions(WORLDS);

  /** The sum of the decided headings' changes. */
  private final float[] effort;

  /**
   * @param self 0 for the evader, 1 for the pursuer
   * @param intervalS between two decisions, or between two commands if it decides first
   * @param decidesFirst whether it decides at every offer, and what waits is the decision
   * @param deadTimeS from a command's arrival until the vehicle follows it
   * @param effort where the sums of the decided headings' changes go, rad
   */
  LaneAgents(
      int self,
      Duelist duelist,
      double periodS,
      Steering steering,
      double intervalS,
      boolean decidesFirst,
      double deadTimeS,
      LaneFlights flights,
      LanePolicy policy,
      float[] effort) {
    this.self = self;
    this.flights = flights;
    this.policy = policy;
    this.effort = effort;
    this.decidesFirst = decidesFirst;
    this.periodS = (float) periodS;
    line = Rollout.CommandPlace() + 2 * self;
    startHeading = (float) duelist.startHeadingRad();
    periodGrains = LaneViews.grains(periodS);
    intervalGrains = LaneViews.grains(Math.max(intervalS, steering.minIntervalS()));
    handoverGrains = LaneViews.grains(steering.handoverS());
    deadGrains = LaneViews.grains(deadTimeS);
  }

  void start() {
    for (int[] zero : new int[][] {ready, reaches}) Arrays.fill(zero, 0);
    Arrays.fill(sentAt, LONG_PAST);
    Arrays.fill(decidedBefore, LONG_AGO);
    Arrays.fill(effort, 0f);
    for (Directions each : new Directions[] {sent, sentBefore, decided})
      each.fill(0, WORLDS, startHeading);
    policy.start(startHeading);
    flights.start();
  }

  /** To the next period. */
  void nextRow() {
    IntVector period = IntVector.broadcast(INTS, periodGrains), past = IntVector.broadcast(INTS, LONG_PAST);
    FloatVector seconds = FloatVector.broadcast(SPECIES, periodS);
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector.fromArray(INTS, ready, i).sub(period).max(past).intoArray(ready, i);
      IntVector.fromArray(INTS, reaches, i).sub(period).max(past).intoArray(reaches, i);
      IntVector.fromArray(INTS, sentAt, i).sub(period).max(past).intoArray(sentAt, i);
      FloatVector.fromArray(SPECIES, decidedBefore, i).add(seconds).intoArray(decidedBefore, i);
    }
  }

  /**
   * Decide where it is their turn.
   *
   * @param readAt by vehicle, when the readings held were taken; for policies that ask for ages
   */
  void decide(LaneAgents opponents, LaneOffers offers, LaneVectors vectors, int[][] readAt) {
    look(opponents, vectors, offers.joinedAt, offers.nextAt);
    if (policy.needsVelocity()) {
      difference(vectors, opponents.flights.seenVx, flights.seenVx, sight.dvx);
      difference(vectors, opponents.flights.seenVy, flights.seenVy, sight.dvy);
    }
    if (policy.needsAges()) {
      age(readAt[self], sight.ownAge);
      age(readAt[1 - self], sight.opponentAge);
    }
    policy.decide(sight, decided, 0, known, 0, decidedNow, 0);
  }

  /** When each decides and sends; what of the opponent is known by then, and how far away it was read. */
  private void look(LaneAgents opponents, LaneVectors vectors, int[] joinedAt, int[] nextAt) {
    IntVector none = IntVector.broadcast(INTS, NONE);
    FloatVector undecided = FloatVector.broadcast(SPECIES, LONG_AGO / 2),
        grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        zero = FloatVector.broadcast(SPECIES, 0f);
    LaneFlights theirs = opponents.flights;
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector joined = IntVector.fromArray(INTS, joinedAt, i);
      IntVector when = joined.max(IntVector.fromArray(INTS, ready, i));
      VectorMask<Integer> offered = joined.compare(LT, none);
      VectorMask<Integer> goes = when.compare(LT, IntVector.fromArray(INTS, nextAt, i)).and(offered);
      IntVector sending = none.blend(when, goes), deciding = decidesFirst ? joined : sending;
      sending.intoArray(sends, i);
      deciding.intoArray(decides, i);
      FloatVector time = (FloatVector) deciding.convertShape(VectorOperators.I2F, SPECIES, 0);
      FloatVector before = FloatVector.fromArray(SPECIES, decidedBefore, i);
      zero.blend(time.fma(grainS, before), before.compare(LT, undecided)).intoArray(sight.elapsed, i);
      // What the opponent sends after the offer was made is not known in it.
      VectorMask<Float> isKnown =
          IntVector.fromArray(INTS, opponents.sentAt, i).compare(LE, joined).cast(SPECIES);
      FloatVector.fromArray(SPECIES, opponents.sentBefore.cos, i)
          .blend(FloatVector.fromArray(SPECIES, opponents.sent.cos, i), isKnown)
          .intoArray(known.cos, i);
      FloatVector.fromArray(SPECIES, opponents.sentBefore.sin, i)
          .blend(FloatVector.fromArray(SPECIES, opponents.sent.sin, i), isKnown)
          .intoArray(known.sin, i);
    }
    difference(vectors, theirs.seenX, flights.seenX, sight.dx);
    difference(vectors, theirs.seenY, flights.seenY, sight.dy);
  }

  private static void difference(LaneVectors vectors, float[] of, float[] and, float[] into) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector.fromArray(SPECIES, of, i).sub(FloatVector.fromArray(SPECIES, and, i)).intoArray(into, i);
    }
  }

  private void age(int[] readAt, float[] into) {
    for (int i = 0; i < WORLDS; i += LANES)
      ((FloatVector)
              IntVector.fromArray(INTS, decides, i)
                  .sub(IntVector.fromArray(INTS, readAt, i))
                  .convertShape(VectorOperators.I2F, SPECIES, 0))
          .mul(LaneViews.GRAIN_S)
          .intoArray(into, i);
  }

  /**
   * Command what was decided.
   *
   * @param endGrains of the episode
   */
  void command(int row, LaneOffers offers, LaneVectors vectors, int endGrains) {
    int here = LaneDelays.placeOf(row);
    int[] place = offers.place[self];
    for (int i = 0; i < WORLDS; i += LANES)
      IntVector.fromArray(INTS, place, i).add(here).intoArray(places, i);
    offers.delays.draw(vectors, places, line, there);
    offers.delays.draw(vectors, places, line + 1, back);
    send(vectors);
    remember(vectors, endGrains);
    flights.act(row, vectors, acts, sent);
  }

  private void send(LaneVectors vectors) {
    IntVector none = IntVector.broadcast(INTS, NONE),
        interval = IntVector.broadcast(INTS, intervalGrains),
        handover = IntVector.broadcast(INTS, handoverGrains),
        dead = IntVector.broadcast(INTS, deadGrains);
    FloatVector undecided = FloatVector.broadcast(SPECIES, LONG_AGO / 2);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector when = IntVector.fromArray(INTS, sends, i);
      VectorMask<Integer> goes = when.compare(LT, none);
      VectorMask<Integer> isLater =
          FloatVector.fromArray(SPECIES, decidedBefore, i).compare(LT, undecided).cast(INTS);
      IntVector reachedBefore = IntVector.fromArray(INTS, reaches, i);
      // Commands to one vehicle keep their order.
      IntVector arrives = when.add(IntVector.fromArray(INTS, there, i)).max(reachedBefore);
      none.blend(arrives.add(dead), goes).intoArray(acts, i);
      // The command before is answered when this one has replaced it; the very first replaces none.
      IntVector again = when.add(interval);
      IntVector answered = arrives.add(IntVector.fromArray(INTS, back, i)).add(handover).max(again);
      again = again.blend(answered, isLater);
      reachedBefore.blend(arrives, goes).intoArray(reaches, i);
      IntVector.fromArray(INTS, ready, i).blend(again, goes).intoArray(ready, i);
      IntVector.fromArray(INTS, sentAt, i).blend(when, goes).intoArray(sentAt, i);
      VectorMask<Float> yes = goes.cast(SPECIES);
      FloatVector cos = FloatVector.fromArray(SPECIES, sent.cos, i),
          sin = FloatVector.fromArray(SPECIES, sent.sin, i);
      cos.intoArray(sentBefore.cos, i, yes);
      sin.intoArray(sentBefore.sin, i, yes);
      FloatVector.fromArray(SPECIES, decidedNow.cos, i).intoArray(sent.cos, i, yes);
      FloatVector.fromArray(SPECIES, decidedNow.sin, i).intoArray(sent.sin, i, yes);
    }
  }

  private void remember(LaneVectors vectors, int endGrains) {
    IntVector none = IntVector.broadcast(INTS, NONE), end = IntVector.broadcast(INTS, endGrains);
    FloatVector grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector when = IntVector.fromArray(INTS, decides, i);
      VectorMask<Float> yes = when.compare(LT, none).cast(SPECIES);
      FloatVector time = (FloatVector) when.convertShape(VectorOperators.I2F, SPECIES, 0);
      time.mul(grainS).neg().intoArray(decidedBefore, i, yes);
      FloatVector spent = FloatVector.fromArray(SPECIES, effort, i);
      spent
          .add(FloatVector.fromArray(SPECIES, policy.turned, i), when.compare(LT, end).cast(SPECIES))
          .intoArray(effort, i);
      FloatVector.fromArray(SPECIES, policy.newHeading, i).intoArray(policy.heading, i, yes);
      FloatVector.fromArray(SPECIES, decidedNow.cos, i).intoArray(decided.cos, i, yes);
      FloatVector.fromArray(SPECIES, decidedNow.sin, i).intoArray(decided.sin, i, yes);
    }
    if (vectors.count * LANES < WORLDS) forget(vectors);
    policy.rememberBefore(decides, 0, NONE);
  }

  /** Nobody decides in the other vectors. */
  private void forget(LaneVectors vectors) {
    int next = 0;
    for (int i = 0; i < WORLDS; i += LANES)
      if (next < vectors.count && vectors.first[next] == i) next++;
      else Arrays.fill(decides, i, i + LANES, NONE);
  }
}
