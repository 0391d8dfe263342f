package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.XOR;
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
import skein.simd.WorldRandom;

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

  final LaneVehicles vehicles;
  final LanePolicy policy;
  private final int self, line, periodGrains, intervalGrains, handoverGrains, deadGrains;
  private final float startHeading, periodS;
  private final boolean decidesFirst, together;

  // When it may be commanded again, when the last command reaches it, and when that was sent.
  private final int[] ready = new int[WORLDS], reaches = new int[WORLDS], sentAt = new int[WORLDS];

  // When it decides, and when it sends; NONE where it does not. When the command acts.
  private final int[] decides = new int[WORLDS], sends = new int[WORLDS], acts = new int[WORLDS];

  /** How long before the period's begin it decided, s. */
  private final float[] decidedBefore = new float[WORLDS];

  private final int[] drawn = new int[2 * LANES];
  private final LaneObservation sight = new LaneObservation();

  /** What was sent last and before that, what was decided last, and what is now. */
  final Directions sent = new Directions(WORLDS), sentBefore = new Directions(WORLDS);

  private final Directions known = new Directions(WORLDS), decidedNow = new Directions(WORLDS);

  /** That which is sent, unless what waits is the decision. */
  private final Directions decided;

  /** The sum of the decided headings' changes. */
  private final float[] effort;

  /**
   * @param self 0 for the evader, 1 for the pursuer
   * @param intervalS between two decisions, or between two commands if it decides first
   * @param decidesFirst whether it decides at every offer, and what waits is the decision
   * @param together whether the opponent is offered the same at the same time: then all that it has sent
   *     was sent before
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
      boolean together,
      double deadTimeS,
      LaneVehicles vehicles,
      LanePolicy policy,
      float[] effort) {
    this.self = self;
    this.vehicles = vehicles;
    this.policy = policy;
    this.effort = effort;
    this.decidesFirst = decidesFirst;
    this.together = together;
    decided = decidesFirst ? new Directions(WORLDS) : sent;
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
    vehicles.start();
  }

  /** To the next period. */
  void nextRow() {
    IntVector period = IntVector.broadcast(INTS, periodGrains), past = IntVector.broadcast(INTS, LONG_PAST);
    FloatVector seconds = FloatVector.broadcast(SPECIES, periodS);
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector.fromArray(INTS, ready, i).sub(period).max(past).intoArray(ready, i);
      IntVector.fromArray(INTS, reaches, i).sub(period).max(past).intoArray(reaches, i);
      if (!together) IntVector.fromArray(INTS, sentAt, i).sub(period).max(past).intoArray(sentAt, i);
      FloatVector.fromArray(SPECIES, decidedBefore, i).add(seconds).intoArray(decidedBefore, i);
    }
  }

  /**
   * Decide where it is their turn.
   *
   * @param readAt by vehicle, when the readings held were taken; for policies that ask for ages
   */
  void decide(LaneAgents opponents, LaneOffers offers, LaneVectors vectors, int[][] readAt) {
    look(vectors, offers.joinedAt, offers.nextAt);
    see(LaneObservation.X, opponents, LaneVehicles.SEEN_X);
    see(LaneObservation.Y, opponents, LaneVehicles.SEEN_Y);
    if (policy.needsVelocity()) {
      see(LaneObservation.VX, opponents, LaneVehicles.SEEN_VX);
      see(LaneObservation.VY, opponents, LaneVehicles.SEEN_VY);
    }
    if (policy.needsAges()) {
      age(readAt[self], sight.ownAge);
      age(readAt[1 - self], sight.opponentAge);
    }
    if (!together) know(opponents, vectors, offers.joinedAt);
    policy.decide(sight, decided, 0, together ? opponents.sent : known, 0, decidedNow, 0);
  }

  /** What the opponent sends after the offer was made is not known in it. */
  private void know(LaneAgents opponents, LaneVectors vectors, int[] joinedAt) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      VectorMask<Float> isKnown =
          IntVector.fromArray(INTS, opponents.sentAt, i)
              .compare(LE, IntVector.fromArray(INTS, joinedAt, i))
              .cast(SPECIES);
      FloatVector.fromArray(SPECIES, opponents.sentBefore.cos, i)
          .blend(FloatVector.fromArray(SPECIES, opponents.sent.cos, i), isKnown)
          .intoArray(known.cos, i);
      FloatVector.fromArray(SPECIES, opponents.sentBefore.sin, i)
          .blend(FloatVector.fromArray(SPECIES, opponents.sent.sin, i), isKnown)
          .intoArray(known.sin, i);
    }
  }

  private void see(int what, LaneAgents opponents, int from) {
    sight.see(what, opponents.vehicles.state, from, vehicles.state, from);
  }

  /** When each decides and sends. */
  private void look(LaneVectors vectors, int[] joinedAt, int[] nextAt) {
    IntVector none = IntVector.broadcast(INTS, NONE);
    FloatVector undecided = FloatVector.broadcast(SPECIES, LONG_AGO / 2),
        grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        zero = FloatVector.broadcast(SPECIES, 0f);
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
    send(LaneDelays.placeOf(row) + line * WorldRandom.STRIDE, offers.delays, offers.place[self], vectors, endGrains);
    if (vectors.count * LANES < WORLDS) forget(vectors);
    policy.rememberBefore(decides, 0, NONE);
    vehicles.act(row, vectors, acts, sent);
  }

  /** Draws its delays in the same pass: a look into a table takes as long as a dozen other operations. */
  private void send(int place, LaneDelays delays, int[] places, LaneVectors vectors, int endGrains) {
    int[] keys = delays.keys, tableOf = delays.tableOf, table = delays.delays, drawn = this.drawn;
    IntVector here = IntVector.broadcast(INTS, place),
        next = IntVector.broadcast(INTS, place + WorldRandom.STRIDE),
        multiplier1 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_1),
        multiplier2 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_2),
        none = IntVector.broadcast(INTS, NONE),
        interval = IntVector.broadcast(INTS, intervalGrains),
        handover = IntVector.broadcast(INTS, handoverGrains),
        dead = IntVector.broadcast(INTS, deadGrains),
        end = IntVector.broadcast(INTS, endGrains);
    FloatVector undecided = FloatVector.broadcast(SPECIES, LONG_AGO / 2),
        minusGrainS = FloatVector.broadcast(SPECIES, -LaneViews.GRAIN_S);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector key = IntVector.fromArray(INTS, keys, i).add(IntVector.fromArray(INTS, places, i)),
          begin = IntVector.fromArray(INTS, tableOf, i);
      IntVector a = key.add(here), b = key.add(next);
      a = a.lanewise(XOR, a.lanewise(LSHR, 16)).mul(multiplier1);
      b = b.lanewise(XOR, b.lanewise(LSHR, 16)).mul(multiplier1);
      a = a.lanewise(XOR, a.lanewise(LSHR, 15)).mul(multiplier2);
      b = b.lanewise(XOR, b.lanewise(LSHR, 15)).mul(multiplier2);
      a.lanewise(LSHR, LaneDelays.DROP).add(begin).intoArray(drawn, 0);
      b.lanewise(LSHR, LaneDelays.DROP).add(begin).intoArray(drawn, LANES);
      IntVector there = IntVector.fromArray(INTS, table, 0, drawn, 0),
          back = IntVector.fromArray(INTS, table, 0, drawn, LANES);
      IntVector when = IntVector.fromArray(INTS, sends, i), time = IntVector.fromArray(INTS, decides, i);
      VectorMask<Integer> goes = when.compare(LT, none);
      VectorMask<Float> sending = goes.cast(SPECIES), deciding = time.compare(LT, none).cast(SPECIES);
      FloatVector before = FloatVector.fromArray(SPECIES, decidedBefore, i);
      IntVector reachedBefore = IntVector.fromArray(INTS, reaches, i);
      // Commands to one vehicle keep their order.
      IntVector arrives = when.add(there).max(reachedBefore);
      none.blend(arrives.add(dead), goes).intoArray(acts, i);
      // The command before is answered when this one has replaced it; the very first replaces none.
      IntVector again = when.add(interval);
      again =
          again.blend(
              arrives.add(back).add(handover).max(again), before.compare(LT, undecided).cast(INTS));
      reachedBefore.blend(arrives, goes).intoArray(reaches, i);
      IntVector.fromArray(INTS, ready, i).blend(again, goes).intoArray(ready, i);
      FloatVector newCos = FloatVector.fromArray(SPECIES, decidedNow.cos, i),
          newSin = FloatVector.fromArray(SPECIES, decidedNow.sin, i),
          cos = FloatVector.fromArray(SPECIES, sent.cos, i),
          sin = FloatVector.fromArray(SPECIES, sent.sin, i);
      if (!together) {
        IntVector.fromArray(INTS, sentAt, i).blend(when, goes).intoArray(sentAt, i);
        cos.intoArray(sentBefore.cos, i, sending);
        sin.intoArray(sentBefore.sin, i, sending);
      }
      cos.blend(newCos, sending).intoArray(sent.cos, i);
      sin.blend(newSin, sending).intoArray(sent.sin, i);
      if (decidesFirst) {
        newCos.intoArray(decided.cos, i, deciding);
        newSin.intoArray(decided.sin, i, deciding);
      }
      FloatVector.fromArray(SPECIES, policy.heading, i)
          .blend(FloatVector.fromArray(SPECIES, policy.newHeading, i), deciding)
          .intoArray(policy.heading, i);
      before
          .blend(((FloatVector) time.convertShape(VectorOperators.I2F, SPECIES, 0)).mul(minusGrainS), deciding)
          .intoArray(decidedBefore, i);
      FloatVector.fromArray(SPECIES, effort, i)
          .add(FloatVector.fromArray(SPECIES, policy.turned, i), time.compare(LT, end).cast(SPECIES))
          .intoArray(effort, i);
    }
  }

  /** Nobody decides in the other vectors. */
  private void forget(LaneVectors vectors) {
    int next = 0;
    for (int i = 0; i < WORLDS; i += LANES)
      if (next < vectors.count && vectors.first[next] == i) next++;
      else Arrays.fill(decides, i, i + LANES, NONE);
  }
}
