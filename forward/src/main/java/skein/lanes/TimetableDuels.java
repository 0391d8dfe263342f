package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.forward.Duel;
import skein.forward.LoopTiming;

/** Duels by {@link TimetableKernel}: the evader is vehicle 0. */
final class TimetableDuels extends DuelKernel implements TimetableScores {
  private static final FloatVector INFINITE = constant(Float.POSITIVE_INFINITY);

  private final int steps;
  private final TimetableVehicles evaders, pursuers;
  private final TimetableKernel kernel;

  private final float[] sum = new float[WORLDS], lastSum = new float[WORLDS];
  private int lastScores;
  private FloatVector captureRadius = constant(0);

  /**
   * @param duel start, speeds and duration; its policies are not used
   * @param model the same as the timetables'
   * @param pursuerPolicy takes the parameters of each candidate's pursuer before it flies
   */
  TimetableDuels(
      Duel duel,
      LoopTiming timing,
      TimetableModel model,
      LanePolicy pursuerPolicy,
      LanePolicy evaderPolicy) {
    this(duel, timing, model, pursuerPolicy, evaderPolicy, null, null);
  }

  /**
   * @param pursuerEye by which alone the pursuer knows of the evader; null for one that is told
   */
  TimetableDuels(
      Duel duel,
      LoopTiming timing,
      TimetableModel model,
      LanePolicy pursuerPolicy,
      LanePolicy evaderPolicy,
      EyeLanes pursuerEye,
      EyeLanes evaderEye) {
    steps = (int) Math.round(duel.durationS() / timing.periodS());
    LaneObservation sight = new LaneObservation();
    DuelAgents evader = new DuelAgents(0, duel.evader(), model, evaderPolicy, evaderEffortRad, sight, false, evaderEye),
        pursuer = new DuelAgents(1, duel.pursuer(), model, pursuerPolicy, pursuerEffortRad, sight, false, pursuerEye);
    evaders = evader.vehicles;
    pursuers = pursuer.vehicles;
    kernel = new TimetableKernel(new TimetableAgents[] {evader, pursuer}, this);
  }

  /**
   * Flies {@link #WORLDS} candidates through one episode, by the policies' parameters.
   *
   * @param worlds those that count are the first
   * @param captureRadiusM a distance of at most this is a capture
   */
  void fly(Timetable timetable, int worlds, float captureRadiusM) {
    captureRadius = constant(captureRadiusM);
    kernel.fly(timetable, worlds);
  }

  @Override
  public void start() {
    Arrays.fill(minDistance, Float.POSITIVE_INFINITY);
    Arrays.fill(captureS, Float.POSITIVE_INFINITY);
    Arrays.fill(sum, 0f);
    Arrays.fill(lastSum, 0f);
    lastScores = 0;
  }

  /** The distance between readings of the vehicles as they are now. */
  @Override
  public void score(
      TimetableAgents[] agents, int[] views, int view, boolean isLast, float timeS) {
    if (isLast) lastScores++;
    int evaderSeen = views[view] * WORLDS, pursuerSeen = views[view + 1] * WORLDS;
    FloatVector time = constant(timeS), radius = captureRadius;
    float[] evaderX = evaders.seenX, evaderY = evaders.seenY;
    float[] pursuerX = pursuers.seenX, pursuerY = pursuers.seenY;
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
          .blend(time, now.compare(LE, radius))
          .min(FloatVector.fromArray(SPECIES, captureS, i))
          .intoArray(captureS, i);
    }
  }

  @Override
  public void finish() {
    for (int i = 0; i < WORLDS; i++) {
      meanDistance[i] = sum[i] / steps;
      meanLast10s[i] = lastSum[i] / lastScores;
    }
  }
}
