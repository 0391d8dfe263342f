package skein.bench;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;

/** Angles of many points, by hand-written SIMD, as a pass of {@link ChauffeurKernel}. */
public final class Atan2 {
  private Atan2() {}

  private static final float QUARTER_PI = 0.785398163f;

  // Minimax on ±tan(π/8), from Cephes' atanf.c.
  private static final float ATAN_3 = -3.33329491539e-1f;
  private static final float ATAN_5 = 1.99777106478e-1f;
  private static final float ATAN_7 = -1.38776856032e-1f;
  private static final float ATAN_9 = 8.05374449538e-2f;
  private static final float TAN_PI_8 = 0.41421356f;
  private static final float TINY = 1e-30f;

  /**
   * Angles of the first {@code count} points (x, y), rad, −π to π; 0 for the origin. Absolute error
   * below 3e-7. The sign of a zero y is kept, as {@code Math.atan2} does; a zero x counts as
   * positive whatever its sign.
   *
   * @param count a multiple of {@link #LANES}
   */
  public static void atan2(float[] ys, float[] xs, float[] angles, int count) {
    FloatVector tiny = FloatVector.broadcast(SPECIES, TINY),
        tanPi8 = FloatVector.broadcast(SPECIES, TAN_PI_8),
        atan3 = FloatVector.broadcast(SPECIES, ATAN_3),
        atan5 = FloatVector.broadcast(SPECIES, ATAN_5),
        atan7 = FloatVector.broadcast(SPECIES, ATAN_7),
        atan9 = FloatVector.broadcast(SPECIES, ATAN_9),
        quarterPi = FloatVector.broadcast(SPECIES, QUARTER_PI),
        halfPi = FloatVector.broadcast(SPECIES, 1.57079633f),
        pi = FloatVector.broadcast(SPECIES, 3.14159265f),
        zero = FloatVector.broadcast(SPECIES, 0f);
    IntVector signBit = IntVector.broadcast(INTS, Integer.MIN_VALUE);
    for (int i = 0; i < count; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, xs, i);
      FloatVector y = FloatVector.fromArray(SPECIES, ys, i);
      FloatVector ax = x.abs();
      FloatVector ay = y.abs();
      VectorMask<Float> steep = ay.compare(GT, ax);
      FloatVector large = ax.blend(ay, steep).add(tiny);
      FloatVector small = ay.blend(ax, steep);
      // Above 22.5° by atan t = π/4 + atan((t − 1) / (t + 1)): one division serves both cases.
      VectorMask<Float> beyond = small.compare(GT, large.mul(tanPi8));
      FloatVector ratio =
          small.blend(small.sub(large), beyond).div(large.blend(large.add(small), beyond));
      FloatVector square = ratio.mul(ratio);
      FloatVector series =
          square.fma(atan9, atan7).fma(square, atan5).fma(square, atan3).mul(square);
      FloatVector angle = series.fma(ratio, ratio);
      angle = angle.blend(angle.add(quarterPi), beyond);
      angle = angle.blend(halfPi.sub(angle), steep);
      angle = angle.blend(pi.sub(angle), x.compare(LT, zero));
      IntVector sign = y.reinterpretAsInts().and(signBit);
      angle.reinterpretAsInts().or(sign).reinterpretAsFloats().intoArray(angles, i);
    }
  }
}
