package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LE;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.forward.Rollout;

/** Adds up the distances of many worlds as they come, once a period. */
final class LaneScores {
  private static final int WORLDS = LanePolicy.WORLDS;

  private final int steps;
  private final double durationS, periodS;
  private final DuelKernel into;
  private float captureRadiusM;
  private int lastScores;
  private final float[] sum = new float[WORLDS], lastSum = new float[WORLDS];

  LaneScores(double durationS, double periodS, DuelKernel into) {
    this.into = into;
    this.durationS = durationS;
    this.periodS = periodS;
    steps = (int) Math.round(durationS / periodS);
  }

  /**
   * @param captureRadiusM a distance of at most this is a capture
   */
  void start(float captureRadiusM) {
    this.captureRadiusM = captureRadiusM;
    lastScores = 0;
    Arrays.fill(into.minDistance, Float.POSITIVE_INFINITY);
    Arrays.fill(into.captureS, Float.POSITIVE_INFINITY);
    Arrays.fill(sum, 0f);
    Arrays.fill(lastSum, 0f);
  }

  /**
   * Adds the distances of two vehicles at the end of a period, counted from 1.
   *
   * @param evaders and pursuers: positions as {@link LaneVehicles#state} has them
   */
  void add(int period, float[] evaders, float[] pursuers) {
    FloatVector time = FloatVector.broadcast(SPECIES, (float) (period * periodS)),
        radius = FloatVector.broadcast(SPECIES, captureRadiusM),
        infinite = FloatVector.broadcast(SPECIES, Float.POSITIVE_INFINITY);
    boolean isLast = Rollout.isLast10s(period * periodS, durationS);
    if (isLast) lastScores++;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector
          x =
              FloatVector.fromArray(SPECIES, evaders, LaneVehicles.X + i)
                  .sub(FloatVector.fromArray(SPECIES, pursuers, LaneVehicles.X + i)),
          y =
              FloatVector.fromArray(SPECIES, evaders, LaneVehicles.Y + i)
                  .sub(FloatVector.fromArray(SPECIES, pursuers, LaneVehicles.Y + i));
      FloatVector now = x.fma(x, y.mul(y)).sqrt();
      FloatVector.fromArray(SPECIES, into.minDistance, i).min(now).intoArray(into.minDistance, i);
      FloatVector.fromArray(SPECIES, sum, i).add(now).intoArray(sum, i);
      if (isLast) FloatVector.fromArray(SPECIES, lastSum, i).add(now).intoArray(lastSum, i);
      infinite
          .blend(time, now.compare(LE, radius))
          .min(FloatVector.fromArray(SPECIES, into.captureS, i))
          .intoArray(into.captureS, i);
    }
  }

  /** At the end of the episode. */
  void finish() {
    for (int i = 0; i < WORLDS; i++) {
      into.meanDistance[i] = sum[i] / steps;
      into.meanLast10s[i] = lastSum[i] / lastScores;
    }
  }
}
