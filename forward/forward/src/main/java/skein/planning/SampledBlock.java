package skein.planning;

import static jdk.incubator.vector.VectorOperators.LSHR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import skein.simd.LaneRandom;

/** Draws a block's candidates with SIMD. */
abstract class SampledBlock extends CandidateBlock {
  // The sum of a hash's four bytes is nearly normal, with mean 510; this is the reciprocal of its standard
  // deviation.
  private static final float NORMAL_SCALE = Draws.Scale();
  private static final int BYTES = 0x00ff00ff;
  private static final int LOWER = 0xffff;

  /** The bits of the float 2²³. Added to an integer below 2²³, they give the bits of the float 2²³ plus that
   * integer.
   */
  private static final int FLOAT_BITS = 0x4b000000;

  private static final float FLOAT_BASE = 8388608f + 510f;

  private static final int SIZE = CandidateBlock.Size();

  private final int steps;
  private final int[] bits = new int[SIZE];
  private final float[] turnNoise = new float[SIZE], speedNoise = new float[SIZE];

  SampledBlock(int steps) {
    super(steps);
    this.steps = steps;
  }

  @Override
  public void draw(int[] keys, SamplingDistribution from, CommandLimits limits, int stepsPerKnot) {
    for (int step = 0, knot = 0; step < steps; step += stepsPerKnot, knot++) {
      noise(keys, 2 * knot, turnNoise);
      noise(keys, 2 * knot + 1, speedNoise);
      int end = Math.min(steps, step + stepsPerKnot);
      for (int each = step; each < end; each++) perturb(each, from, limits);
    }
  }

  private void noise(int[] keys, int place, float[] into) {
    LaneRandom.bits(keys, place, bits, SIZE);
    IntVector bytes = IntVector.broadcast(INTS, BYTES),
        lower = IntVector.broadcast(INTS, LOWER),
        floatBits = IntVector.broadcast(INTS, FLOAT_BITS);
    FloatVector base = FloatVector.broadcast(SPECIES, FLOAT_BASE),
        scale = FloatVector.broadcast(SPECIES, NORMAL_SCALE);
    for (int i = 0; i < SIZE; i += LANES) {
      IntVector drawn = IntVector.fromArray(INTS, bits, i);
      IntVector pairs = drawn.and(bytes).add(drawn.lanewise(LSHR, 8).and(bytes));
      IntVector sum = pairs.and(lower).add(pairs.lanewise(LSHR, 16));
      sum.or(floatBits)
          .reinterpretAsFloats()
          .sub(base)
          .mul(scale)
          .intoArray(into, i);
    }
  }

  private void perturb(int step, SamplingDistribution from, CommandLimits limits) {
    float[] turnRates = turnRates(), speeds = speeds();
    FloatVector slowest = FloatVector.broadcast(SPECIES, (float) limits.minSpeed());
    FloatVector fastest = FloatVector.broadcast(SPECIES, (float) limits.maxSpeed());
    FloatVector steepest = FloatVector.broadcast(SPECIES, (float) limits.maxTurnRate());
    FloatVector curvature = FloatVector.broadcast(SPECIES, (float) limits.curvature());
    FloatVector turnMean = FloatVector.broadcast(SPECIES, from.turnMeans()[step]);
    FloatVector turnSd = FloatVector.broadcast(SPECIES, from.turnSds()[step]);
    FloatVector speedMean = FloatVector.broadcast(SPECIES, from.speedMeans()[step]);
    FloatVector speedSd = FloatVector.broadcast(SPECIES, from.speedSds()[step]);
    for (int i = 0, at = step * SIZE; i < SIZE; i += LANES, at += LANES) {
      FloatVector speed =
          FloatVector.fromArray(SPECIES, speedNoise, i)
              .fma(speedSd, speedMean)
              .max(slowest)
              .min(fastest);
      FloatVector limit = speed.mul(curvature).min(steepest);
      FloatVector turn = FloatVector.fromArray(SPECIES, turnNoise, i).fma(turnSd, turnMean);
      turn.max(limit.neg()).min(limit).intoArray(turnRates, at);
      speed.intoArray(speeds, at);
    }
  }
}
