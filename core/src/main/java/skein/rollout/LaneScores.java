package skein.rollout;

import static jdk.incubator.vector.VectorOperators.LE;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;

/** Adds up the distances of many worlds as they come, once a period. */
final class LaneScores {
  private static final int WORLDS = LanePolicy.WORLDS;
  private static final FloatVector INFINITE = constant(Float.POSITIVE_INFINITY);

  private final int steps, lastSteps;
  private final double periodS;
  private final DuelKernel into;
  private FloatVector captureRadius;
  private final float[] sum = new float[WORLDS], lastSum = new float[WORLDS];

  /** The distances now, m. */
  final float[] distance = new float[WORLDS];

  LaneScores(double durationS, double periodS, DuelKernel into) {
    this.into = into;
    this.periodS = periodS;
    steps = (int) Math.round(durationS / periodS);
    lastSteps = Math.min(steps, (int) Math.round(10 / periodS));
  }

  /**
   * @param captureRadiusM a distance of at most this is a capture
   */
  void start(float captureRadiusM) {
    captureRadius = constant(captureRadiusM);
    Arrays.fill(into.minDistance, Float.POSITIVE_INFINITY);
    Arrays.fill(into.captureS, Float.POSITIVE_INFINITY);
    Arrays.fill(sum, 0f);
    Arrays.fill(lastSum, 0f);
  }

  /** Adds {@link #distance} at the end of a period, counted from 1. */
  void add(int period) {
    FloatVector time = constant((float) (period * periodS));
    boolean isLast = period > steps - lastSteps;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector now = FloatVector.fromArray(SPECIES, distance, i);
      FloatVector.fromArray(SPECIES, into.minDistance, i).min(now).intoArray(into.minDistance, i);
      FloatVector.fromArray(SPECIES, sum, i).add(now).intoArray(sum, i);
      if (isLast) FloatVector.fromArray(SPECIES, lastSum, i).add(now).intoArray(lastSum, i);
      INFINITE
          .blend(time, now.compare(LE, captureRadius))
          .min(FloatVector.fromArray(SPECIES, into.captureS, i))
          .intoArray(into.captureS, i);
    }
  }

  /** At the end of the episode. */
  void finish() {
    for (int i = 0; i < WORLDS; i++) {
      into.meanDistance[i] = sum[i] / steps;
      into.meanLast10s[i] = lastSum[i] / lastSteps;
    }
  }
}
