package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.forward.Duel;
import skein.forward.Duelist;
import skein.forward.LoopTiming;

/**
 * Flies many candidates through one episode, by its {@link Timetable}: duels under any loop's
 * timing, with any vehicles that fly by timetables. {@link Rollout} with the same delays and the
 * same model is its scalar reference.
 *
 * <p>What happens when is the same in all lanes, so that everything about time is a number of the
 * timetable. Nothing is allocated after construction but where a timetable needs more places than
 * any before; one instance per thread.
 */
final class TimetableKernel extends DuelKernel {
  private static final FloatVector INFINITE = constant(Float.POSITIVE_INFINITY);

  /** Kinds of a timetable's operations. */
  static final int LOOK = 0, DECIDE = 1, ACT = 2, SCORE = 3;

  private static final int EVADER = 0;
  private final int steps;
  private final Agents evader, pursuer;
  private final boolean withVelocity;

  private final float[] sum = new float[WORLDS], lastSum = new float[WORLDS];
  private final LaneSight sight = new LaneSight();

  /** All worlds' agents of one role: the vehicles, and who decides for them. */
  private static final class Agents {
    final TimetableVehicles vehicles;
    final LanePolicy policy;
    final float[] effort;
    final float startHeading;

    /** Decided directions, by place. */
    final Directions headings = new Directions(0);

    Agents(Duelist duelist, TimetableModel model, LanePolicy policy, float[] effort) {
      vehicles = model.vehicles(duelist);
      this.policy = policy;
      this.effort = effort;
      startHeading = (float) duelist.startHeadingRad();
    }

    void start(Timetable timetable, int worlds) {
      vehicles.start(timetable.readings(), worlds);
      headings.reserve(timetable.headings() * WORLDS);
      // The timetable keeps the first heading at place 0.
      headings.fill(0, WORLDS, startHeading);
      policy.start(startHeading);
    }
  }

  /**
   * @param duel start, speeds and duration; its policies are not used
   * @param model the same as the timetables'
   * @param pursuerPolicy takes the parameters of each candidate's pursuer before it flies
   */
  TimetableKernel(
      Duel duel,
      LoopTiming timing,
      TimetableModel model,
      LanePolicy pursuerPolicy,
      LanePolicy evaderPolicy) {
    steps = (int) Math.round(duel.durationS() / timing.periodS());
    withVelocity = pursuerPolicy.needsVelocity() || evaderPolicy.needsVelocity();
    evader = new Agents(duel.evader(), model, evaderPolicy, evaderEffortRad);
    pursuer = new Agents(duel.pursuer(), model, pursuerPolicy, pursuerEffortRad);
  }

  /**
   * Flies {@link #WORLDS} candidates through one episode, by the policies' parameters.
   *
   * @param worlds those that count are the first
   * @param captureRadiusM a distance of at most this is a capture
   */
  void fly(Timetable timetable, int worlds, float captureRadiusM) {
    evader.start(timetable, worlds);
    pursuer.start(timetable, worlds);
    Arrays.fill(minDistance, Float.POSITIVE_INFINITY);
    Arrays.fill(captureS, Float.POSITIVE_INFINITY);
    for (float[] zero : new float[][] {sum, lastSum, pursuerEffortRad, evaderEffortRad})
      Arrays.fill(zero, 0f);
    FloatVector captureRadius = constant(captureRadiusM);
    int[] operations = timetable.operations();
    float[] times = timetable.times();
    int lastScores = 0;
    for (int i = 0; i < timetable.size(); i++) {
      int field = i * Timetable.Fields(), number = i * Timetable.Numbers();
      Agents agent = operations[field + 1] == EVADER ? evader : pursuer;
      int place = operations[field + 2] * WORLDS, second = operations[field + 3] * WORLDS;
      switch (operations[field]) {
        case LOOK -> agent.vehicles.look(times, number, place, withVelocity);
        case ACT -> agent.vehicles.act(times, number, agent.headings, place);
        case SCORE -> {
          boolean isLast = operations[field + 4] != 0;
          if (isLast) lastScores++;
          score(place, second, isLast, times[number], captureRadius);
        }
        default ->
            decide(
                agent,
                place,
                second,
                operations[field + 4] * WORLDS,
                operations[field + 5] * WORLDS,
                operations[field + 6] * WORLDS,
                times,
                number);
      }
    }
    for (int i = 0; i < WORLDS; i++) {
      meanDistance[i] = sum[i] / steps;
      meanLast10s[i] = lastSum[i] / lastScores;
    }
  }

  /** An agent decides on these readings, knowing the opponent's heading at a place. */
  private void decide(
      Agents own,
      int evaderSeen,
      int pursuerSeen,
      int known,
      int before,
      int after,
      float[] times,
      int number) {
    Agents opponent = own == evader ? pursuer : evader;
    TimetableVehicles ours = own.vehicles, theirs = opponent.vehicles;
    int ownSeen = own == evader ? evaderSeen : pursuerSeen,
        opponentSeen = own == evader ? pursuerSeen : evaderSeen;
    difference(theirs.seenX, opponentSeen, ours.seenX, ownSeen, sight.dx);
    difference(theirs.seenY, opponentSeen, ours.seenY, ownSeen, sight.dy);
    if (own.policy.needsVelocity()) {
      difference(theirs.seenVx, opponentSeen, ours.seenVx, ownSeen, sight.dvx);
      difference(theirs.seenVy, opponentSeen, ours.seenVy, ownSeen, sight.dvy);
    }
    Arrays.fill(sight.elapsed, times[number]);
    if (own.policy.needsAges()) {
      Arrays.fill(sight.ownAge, times[number + 1]);
      Arrays.fill(sight.opponentAge, times[number + 2]);
    }
    own.policy.decide(
        sight, own.headings, before, opponent.headings, known, own.headings, after);
    own.policy.commit();
    add(own.policy.turned, own.effort);
  }

  private static void difference(float[] of, int ofAt, float[] and, int andAt, float[] into) {
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, of, ofAt + i)
          .sub(FloatVector.fromArray(SPECIES, and, andAt + i))
          .intoArray(into, i);
  }

  private static void add(float[] what, float[] to) {
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, to, i)
          .add(FloatVector.fromArray(SPECIES, what, i))
          .intoArray(to, i);
  }

  /** The distance between readings of the vehicles as they are now. */
  private void score(
      int evaderSeen, int pursuerSeen, boolean isLast, float timeS, FloatVector captureRadius) {
    FloatVector time = constant(timeS);
    float[] evaderX = evader.vehicles.seenX, evaderY = evader.vehicles.seenY;
    float[] pursuerX = pursuer.vehicles.seenX, pursuerY = pursuer.vehicles.seenY;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x =
          FloatVector.fromArray(SPECIES, evaderX, evaderSeen + i)
              .sub(FloatVector.fromArray(SPECIES, pursuerX, pursuerSeen + i));
      FloatVector y =
          FloatVector.fromArray(SPECIES, evaderY, evaderSeen + i)
              .sub(FloatVector.fromArray(SPECIES, pursuerY, pursuerSeen + i));
      FloatVector now = x.fma(x, y.mul(y)).sqrt();
      FloatVector least = FloatVector.fromArray(SPECIES, minDistance, i);
      least.blend(now, now.compare(LT, least)).intoArray(minDistance, i);
      FloatVector.fromArray(SPECIES, sum, i).add(now).intoArray(sum, i);
      if (isLast) FloatVector.fromArray(SPECIES, lastSum, i).add(now).intoArray(lastSum, i);
      INFINITE
          .blend(time, now.compare(LE, captureRadius))
          .min(FloatVector.fromArray(SPECIES, captureS, i))
          .intoArray(captureS, i);
    }
  }
}
