package skein.rollout;

import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;

/**
 * Flies many candidates through one episode, by its {@link Timetable}: duels with vehicles of
 * first-order lag, exactly integrated between commands, under any loop's timing. {@link Rollout}
 * with the same delays and a {@code Reduced} model is its scalar reference.
 *
 * <p>What happens when is the same in all lanes, so that exponentials and everything else about
 * time are numbers of the timetable. A vehicle's state is kept as at the last command that acted:
 * position, the velocity asked for, and the velocity's error, which dies away. Nothing is allocated
 * after construction but where a timetable needs more places than any before; one instance per
 * thread.
 */
final class TimetableKernel extends DuelKernel {
  private static final FloatVector INFINITE = constant(Float.POSITIVE_INFINITY);

  /** Kinds of a timetable's operations. */
  static final int LOOK = 0, DECIDE = 1, ACT = 2, SCORE = 3;

  private static final int EVADER = 0;
  private final int steps;
  private final Vehicles evader, pursuer;

  private final float perLag;
  private final boolean withVelocity;

  private final float[] sum = new float[WORLDS], lastSum = new float[WORLDS];
  private final LaneSight sight = new LaneSight();

  /** Between the passes of one operation. */
  private final float[] distance = new float[WORLDS];

  /** All worlds' vehicles of one role. */
  private static final class Vehicles {
    final float startX, startY, startHeading;
    final FloatVector speed;
    final LanePolicy policy;
    final float[] effort;
    final float[] x = new float[WORLDS],
        y = new float[WORLDS],
        askedX = new float[WORLDS],
        askedY = new float[WORLDS],
        errorX = new float[WORLDS],
        errorY = new float[WORLDS];

    /** Readings and decided directions, by place. */
    float[] seenX = {}, seenY = {}, seenVx = {}, seenVy = {};

    final Directions headings = new Directions(0);

    Vehicles(Duelist duelist, double gain, LanePolicy policy, float[] effort) {
      this.policy = policy;
      this.effort = effort;
      startX = (float) duelist.startX();
      startY = (float) duelist.startY();
      startHeading = (float) duelist.startHeadingRad();
      speed = constant((float) (duelist.speed() * gain));
    }

    void start(Timetable timetable) {
      if (seenX.length < timetable.readings() * WORLDS) {
        seenX = new float[timetable.readings() * WORLDS];
        seenY = new float[timetable.readings() * WORLDS];
        seenVx = new float[timetable.readings() * WORLDS];
        seenVy = new float[timetable.readings() * WORLDS];
      }
      headings.reserve(timetable.headings() * WORLDS);
      Arrays.fill(x, startX);
      Arrays.fill(y, startY);
      for (float[] zero : new float[][] {askedX, askedY, errorX, errorY}) Arrays.fill(zero, 0f);
      // The timetable keeps the first heading at place 0.
      headings.fill(0, WORLDS, startHeading);
      policy.start(startHeading);
    }
  }

  /**
   * @param duel start, speeds and duration; its policies are not used
   * @param model lag above 0; the same as the timetables'
   * @param pursuerPolicy takes the parameters of each candidate's pursuer before it flies
   */
  TimetableKernel(
      Duel duel,
      LoopTiming timing,
      Reduced model,
      LanePolicy pursuerPolicy,
      LanePolicy evaderPolicy) {
    if (!(model.lagS() > 0))
      throw new IllegalArgumentException("the kernel needs a lag above 0, got " + model.lagS());
    steps = (int) Math.round(duel.durationS() / timing.periodS());
    perLag = (float) (1 / model.lagS());
    withVelocity = pursuerPolicy.needsVelocity() || evaderPolicy.needsVelocity();
    evader = new Vehicles(duel.evader(), model.gain(), evaderPolicy, evaderEffortRad);
    pursuer = new Vehicles(duel.pursuer(), model.gain(), pursuerPolicy, pursuerEffortRad);
  }

  /**
   * Flies {@link #WORLDS} candidates through one episode, by the policies' parameters.
   *
   * @param captureRadiusM a distance of at most this is a capture
   */
  void fly(Timetable timetable, float captureRadiusM) {
    evader.start(timetable);
    pursuer.start(timetable);
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
      Vehicles vehicle = operations[field + 1] == EVADER ? evader : pursuer;
      int place = operations[field + 2] * WORLDS;
      switch (operations[field]) {
        case LOOK -> {
          look(vehicle, place, times[number], times[number + 1]);
          if (withVelocity) lookAtVelocity(vehicle, place, times[number + 1]);
        }
        case ACT -> act(vehicle, place, times[number], times[number + 1], times[number + 2]);
        case SCORE -> {
          score(times[number], times[number + 1], times[number + 2], times[number + 3]);
          if (place != 0) lastScores++;
          keep(place != 0, Float.intBitsToFloat(operations[field + 3]), captureRadius);
        }
        default ->
            decide(
                vehicle,
                place,
                operations[field + 3] * WORLDS,
                operations[field + 4] * WORLDS,
                operations[field + 5] * WORLDS,
                operations[field + 6] * WORLDS,
                times[number]);
      }
    }
    for (int i = 0; i < WORLDS; i++) {
      meanDistance[i] = sum[i] / steps;
      meanLast10s[i] = lastSum[i] / lastScores;
    }
  }

  /** Where a vehicle is {@code dtS} after its state, as an answer will tell it. */
  private void look(Vehicles each, int place, float dtS, float gainS) {
    FloatVector dt = constant(dtS), gain = constant(gainS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x =
          FloatVector.fromArray(SPECIES, each.askedX, i)
              .fma(dt, FloatVector.fromArray(SPECIES, each.x, i));
      FloatVector y =
          FloatVector.fromArray(SPECIES, each.askedY, i)
              .fma(dt, FloatVector.fromArray(SPECIES, each.y, i));
      FloatVector.fromArray(SPECIES, each.errorX, i)
          .fma(gain, x)
          .intoArray(each.seenX, place + i);
      FloatVector.fromArray(SPECIES, each.errorY, i)
          .fma(gain, y)
          .intoArray(each.seenY, place + i);
    }
  }

  /** How fast it flies then. */
  private void lookAtVelocity(Vehicles each, int place, float gainS) {
    // What is left of the error, for the error's way is lag times what has died away.
    FloatVector keep = constant(1 - gainS * perLag);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector.fromArray(SPECIES, each.errorX, i)
          .fma(keep, FloatVector.fromArray(SPECIES, each.askedX, i))
          .intoArray(each.seenVx, place + i);
      FloatVector.fromArray(SPECIES, each.errorY, i)
          .fma(keep, FloatVector.fromArray(SPECIES, each.askedY, i))
          .intoArray(each.seenVy, place + i);
    }
  }

  /** Flies a vehicle for {@code dtS} and lets a command act from there on. */
  private void act(Vehicles each, int place, float dtS, float gainS, float keepShare) {
    FloatVector dt = constant(dtS), gain = constant(gainS), keep = constant(keepShare);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector askedX = FloatVector.fromArray(SPECIES, each.askedX, i);
      FloatVector errorX = FloatVector.fromArray(SPECIES, each.errorX, i);
      FloatVector newX = FloatVector.fromArray(SPECIES, each.headings.cos, place + i).mul(each.speed);
      errorX
          .fma(gain, askedX.fma(dt, FloatVector.fromArray(SPECIES, each.x, i)))
          .intoArray(each.x, i);
      errorX.fma(keep, askedX.sub(newX)).intoArray(each.errorX, i);
      newX.intoArray(each.askedX, i);
      FloatVector askedY = FloatVector.fromArray(SPECIES, each.askedY, i);
      FloatVector errorY = FloatVector.fromArray(SPECIES, each.errorY, i);
      FloatVector newY = FloatVector.fromArray(SPECIES, each.headings.sin, place + i).mul(each.speed);
      errorY
          .fma(gain, askedY.fma(dt, FloatVector.fromArray(SPECIES, each.y, i)))
          .intoArray(each.y, i);
      errorY.fma(keep, askedY.sub(newY)).intoArray(each.errorY, i);
      newY.intoArray(each.askedY, i);
    }
  }

  /** A vehicle decides on these readings, knowing the opponent's heading at a place. */
  private void decide(
      Vehicles own,
      int evaderSeen,
      int pursuerSeen,
      int known,
      int before,
      int after,
      float elapsedS) {
    Vehicles opponent = own == evader ? pursuer : evader;
    int ownSeen = own == evader ? evaderSeen : pursuerSeen,
        opponentSeen = own == evader ? pursuerSeen : evaderSeen;
    difference(opponent.seenX, opponentSeen, own.seenX, ownSeen, sight.dx);
    difference(opponent.seenY, opponentSeen, own.seenY, ownSeen, sight.dy);
    if (own.policy.needsVelocity()) {
      difference(opponent.seenVx, opponentSeen, own.seenVx, ownSeen, sight.dvx);
      difference(opponent.seenVy, opponentSeen, own.seenVy, ownSeen, sight.dvy);
    }
    Arrays.fill(sight.elapsed, elapsedS);
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

  /** The distance so long after the two vehicles' states. */
  private void score(float evaderS, float evaderGainS, float pursuerS, float pursuerGainS) {
    FloatVector evaderDt = constant(evaderS), evaderGain = constant(evaderGainS);
    FloatVector pursuerDt = constant(-pursuerS), pursuerGain = constant(-pursuerGainS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x =
          FloatVector.fromArray(SPECIES, evader.x, i)
              .sub(FloatVector.fromArray(SPECIES, pursuer.x, i));
      FloatVector y =
          FloatVector.fromArray(SPECIES, evader.y, i)
              .sub(FloatVector.fromArray(SPECIES, pursuer.y, i));
      x = FloatVector.fromArray(SPECIES, evader.askedX, i).fma(evaderDt, x);
      y = FloatVector.fromArray(SPECIES, evader.askedY, i).fma(evaderDt, y);
      x = FloatVector.fromArray(SPECIES, evader.errorX, i).fma(evaderGain, x);
      y = FloatVector.fromArray(SPECIES, evader.errorY, i).fma(evaderGain, y);
      x = FloatVector.fromArray(SPECIES, pursuer.askedX, i).fma(pursuerDt, x);
      y = FloatVector.fromArray(SPECIES, pursuer.askedY, i).fma(pursuerDt, y);
      x = FloatVector.fromArray(SPECIES, pursuer.errorX, i).fma(pursuerGain, x);
      y = FloatVector.fromArray(SPECIES, pursuer.errorY, i).fma(pursuerGain, y);
      x.fma(x, y.mul(y)).sqrt().intoArray(distance, i);
    }
  }

  private void keep(boolean isLast, float timeS, FloatVector captureRadius) {
    FloatVector time = constant(timeS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector now = FloatVector.fromArray(SPECIES, distance, i);
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
