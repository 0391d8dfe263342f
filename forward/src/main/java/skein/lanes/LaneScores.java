package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LE;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;

/** Adds up the distances of duels in many worlds as they come, once a period. */
final class LaneScores implements TimetableScores {
  private static final int WORLDS = LanePolicy.WORLDS;

  private final int steps;
  private final DuelKernel into;
  private float captureRadiusM;
  private int lastScores;
  private final float[] sum = new float[WORLDS], lastSum = new float[WORLDS];

  LaneScores(double durationS, double periodS, DuelKernel into) {
    this.into = into;
    steps = (int) Math.round(durationS / periodS);
  }

  /** A distance of at most this is a capture, m. */
  void captureWithin(float radiusM) {
    captureRadiusM = radiusM;
  }

  @Override
  public void start() {
    lastScores = 0;
    Arrays.fill(into.minDistance, Float.POSITIVE_INFINITY);
    Arrays.fill(into.captureS, Float.POSITIVE_INFINITY);
    Arrays.fill(sum, 0f);
    Arrays.fill(lastSum, 0f);
  }

  /**
   * Adds the distances of two vehicles at the end of a period.
   *
   * @param isLast whether they count for the mean of the last 10 s
   */
  void add(LaneVehicles one, LaneVehicles other, float timeS, boolean isLast) {
    int x = LaneVehicles.X, y = LaneVehicles.Y;
    add(one.state, x, one.state, y, other.state, x, other.state, y, timeS, isLast);
  }

  @Override
  public void score(TimetableAgents[] agents, int[] views, int view, boolean isLast, float timeS) {
    TimetableVehicles one = agents[0].vehicles, other = agents[1].vehicles;
    int at = views[view] * WORLDS, there = views[view + 1] * WORLDS;
    add(one.seenX, at, one.seenY, at, other.seenX, there, other.seenY, there, timeS, isLast);
  }

  /** Between the readings of a timetable's first two vehicles. */
  static void distances(TimetableAgents[] agents, int[] views, int view, float[] into) {
    TimetableVehicles one = agents[0].vehicles, other = agents[1].vehicles;
    int at = views[view] * WORLDS, there = views[view + 1] * WORLDS;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector
          x = FloatVector.fromArray(SPECIES, one.seenX, at + i).sub(FloatVector.fromArray(SPECIES, other.seenX, there + i)),
          y = FloatVector.fromArray(SPECIES, one.seenY, at + i).sub(FloatVector.fromArray(SPECIES, other.seenY, there + i));
      x.fma(x, y.mul(y)).sqrt().intoArray(into, i);
    }
  }

  private void add(
      float[] x1, int x1At, float[] y1, int y1At, float[] x2, int x2At, float[] y2, int y2At,
      float timeS, boolean isLast) {
    float[] least = into.minDistance, captureS = into.captureS, sum = this.sum, lastSum = this.lastSum;
    FloatVector time = FloatVector.broadcast(SPECIES, timeS),
        radius = FloatVector.broadcast(SPECIES, captureRadiusM),
        infinite = FloatVector.broadcast(SPECIES, Float.POSITIVE_INFINITY);
    if (isLast) lastScores++;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector
          x = FloatVector.fromArray(SPECIES, x1, x1At + i).sub(FloatVector.fromArray(SPECIES, x2, x2At + i)),
          y = FloatVector.fromArray(SPECIES, y1, y1At + i).sub(FloatVector.fromArray(SPECIES, y2, y2At + i));
      FloatVector now = x.fma(x, y.mul(y)).sqrt();
      FloatVector.fromArray(SPECIES, least, i).min(now).intoArray(least, i);
      FloatVector.fromArray(SPECIES, sum, i).add(now).intoArray(sum, i);
      if (isLast) FloatVector.fromArray(SPECIES, lastSum, i).add(now).intoArray(lastSum, i);
      infinite
          .blend(time, now.compare(LE, radius))
          .min(FloatVector.fromArray(SPECIES, captureS, i))
          .intoArray(captureS, i);
    }
  }

  @Override
  public void finish() {
    for (int i = 0; i < WORLDS; i++) {
      into.meanDistance[i] = sum[i] / steps;
      into.meanLast10s[i] = lastSum[i] / lastScores;
    }
  }
}
