package skein.rollout;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LSHL;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.XOR;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorSpecies;

/**
 * Elementary functions on lanes of floats, by polynomials: the same bits in every lane, on every
 * machine and at every lane count, and three to four times as fast as {@code lanewise(SIN)}. Error
 * bounds are held by {@code LaneMathSuite}.
 *
 * <p>Kernels are written as passes over blocks of worlds. The compiler stops inlining methods of
 * ours once a compilation holds 18,000 nodes, some 60 vector operations, and a vector that crosses
 * a call is boxed, which costs a factor of ten; methods of the vector API itself it always inlines.
 * So a pass calls none of our methods, and constants are kept as vectors, because each broadcast
 * counts as an operation.
 */
public final class LaneMath {
  private LaneMath() {}

  /** As many lanes as the machine has. Results do not depend on it. */
  public static final VectorSpecies<Float> SPECIES = FloatVector.SPECIES_PREFERRED;

  /** As many lanes of integers as of floats. */
  public static final VectorSpecies<Integer> INTS = IntVector.SPECIES_PREFERRED;

  /** Lanes of {@link #SPECIES}. */
  public static final int LANES = SPECIES.length();

  public static final FloatVector ZERO = constant(0f);
  public static final FloatVector ONE = constant(1f);
  public static final FloatVector HALF_PI = constant(1.57079633f);
  public static final FloatVector PI = constant(3.14159265f);

  private static final FloatVector QUARTER_PI = constant(0.785398163f);
  private static final FloatVector TWO_OVER_PI = constant(0.63661977f);

  /** 1.5·2²³: adding it leaves a float's nearest integer in its lowest bits. */
  static final FloatVector ROUND = constant(12582912f);

  // −π/2 in three parts, the first two short enough for exact products (Cody and Waite; parts from
  // Cephes' sinf.c).
  private static final FloatVector HALF_PI_1 = constant(-1.5703125f);
  private static final FloatVector HALF_PI_2 = constant(-4.837512969970703e-4f);
  private static final FloatVector HALF_PI_3 = constant(-7.549789948768648e-8f);

  // Minimax on ±π/4, from Cephes' sinf.c.
  private static final FloatVector SIN_3 = constant(-1.6666654611e-1f);
  private static final FloatVector SIN_5 = constant(8.3321608736e-3f);
  private static final FloatVector SIN_7 = constant(-1.9515295891e-4f);
  private static final FloatVector COS_2 = constant(-0.5f);
  private static final FloatVector COS_4 = constant(4.166664568298827e-2f);
  private static final FloatVector COS_6 = constant(-1.388731625493765e-3f);
  private static final FloatVector COS_8 = constant(2.443315711809948e-5f);

  // Minimax on ±tan(π/8), from Cephes' atanf.c.
  private static final FloatVector ATAN_3 = constant(-3.33329491539e-1f);
  private static final FloatVector ATAN_5 = constant(1.99777106478e-1f);
  private static final FloatVector ATAN_7 = constant(-1.38776856032e-1f);
  private static final FloatVector ATAN_9 = constant(8.05374449538e-2f);
  private static final FloatVector TAN_PI_8 = constant(0.41421356f);
  private static final FloatVector TINY = constant(1e-30f);

  // For passes that need exponentials in their midst, as `exp` computes them: e^x = 2^k e^r: log₂ e, −ln 2 in two parts, and the series of e^r on ±ln 2 / 2, from Cephes'
  // expf.c.
  static final FloatVector LOG2_E = constant(1.44269504f);
  static final FloatVector LN_2_1 = constant(-0.693359375f);
  static final FloatVector LN_2_2 = constant(2.12194440e-4f);
  static final FloatVector EXP_2 = constant(5.0000001201e-1f);
  static final FloatVector EXP_3 = constant(1.6666665459e-1f);
  static final FloatVector EXP_4 = constant(4.1665795894e-2f);
  static final FloatVector EXP_5 = constant(8.3334519073e-3f);
  static final FloatVector EXP_6 = constant(1.3981999507e-3f);
  static final FloatVector EXP_7 = constant(1.9875691500e-4f);

  private static final IntVector INT_ZERO = IntVector.zero(INTS);
  private static final IntVector INT_ONE = IntVector.broadcast(INTS, 1);
  private static final IntVector INT_TWO = IntVector.broadcast(INTS, 2);
  private static final IntVector SIGN_BIT = IntVector.broadcast(INTS, Integer.MIN_VALUE);

  /** The value in every lane. For static constants. */
  public static FloatVector constant(float value) {
    return FloatVector.broadcast(SPECIES, value);
  }

  /**
   * Sines and cosines of the first {@code count} angles, rad, |angle| up to 8192. Absolute error
   * below 1e-7 to ±π, below 3e-7 to ±8192.
   *
   * @param count a multiple of {@link #LANES}
   */
  public static void sinCos(float[] angles, float[] sines, float[] cosines, int count) {
    sinCos(angles, sines, cosines, 0, count);
  }

  /** The same, into the places from {@code at} on. */
  static void sinCos(float[] angles, float[] sines, float[] cosines, int at, int count) {
    for (int i = 0; i < count; i += LANES) {
      FloatVector angle = FloatVector.fromArray(SPECIES, angles, i);
      FloatVector rounded = angle.fma(TWO_OVER_PI, ROUND);
      FloatVector quarters = rounded.sub(ROUND);
      FloatVector rest =
          quarters.fma(HALF_PI_3, quarters.fma(HALF_PI_2, quarters.fma(HALF_PI_1, angle)));
      FloatVector square = rest.mul(rest);
      FloatVector sin = square.fma(SIN_7, SIN_5).fma(square, SIN_3).mul(square).fma(rest, rest);
      FloatVector cos =
          square.fma(COS_8, COS_6).fma(square, COS_4).fma(square, COS_2).fma(square, ONE);
      IntVector quadrant = rounded.reinterpretAsInts();
      VectorMask<Float> odd = quadrant.lanewise(LSHL, 31).compare(LT, INT_ZERO).cast(SPECIES);
      // Quadrants 2 and 3 negate the sine, 1 and 2 the cosine.
      IntVector sinSign = quadrant.and(INT_TWO).lanewise(LSHL, 30);
      IntVector cosSign = quadrant.add(INT_ONE).and(INT_TWO).lanewise(LSHL, 30);
      sin.blend(cos, odd)
          .reinterpretAsInts()
          .lanewise(XOR, sinSign)
          .reinterpretAsFloats()
          .intoArray(sines, at + i);
      cos.blend(sin, odd)
          .reinterpretAsInts()
          .lanewise(XOR, cosSign)
          .reinterpretAsFloats()
          .intoArray(cosines, at + i);
    }
  }

  /**
   * Angles of the first {@code count} points (x, y), rad, −π to π; 0 for the origin. Absolute error
   * below 3e-7. The sign of a zero y is kept, as {@code Math.atan2} does; a zero x counts as
   * positive whatever its sign.
   *
   * @param count a multiple of {@link #LANES}
   */
  public static void atan2(float[] ys, float[] xs, float[] angles, int count) {
    for (int i = 0; i < count; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, xs, i);
      FloatVector y = FloatVector.fromArray(SPECIES, ys, i);
      FloatVector ax = x.abs();
      FloatVector ay = y.abs();
      VectorMask<Float> steep = ay.compare(GT, ax);
      FloatVector large = ax.blend(ay, steep).add(TINY);
      FloatVector small = ay.blend(ax, steep);
      // Above 22.5° by atan t = π/4 + atan((t − 1) / (t + 1)): one division serves both cases.
      VectorMask<Float> beyond = small.compare(GT, large.mul(TAN_PI_8));
      FloatVector ratio =
          small.blend(small.sub(large), beyond).div(large.blend(large.add(small), beyond));
      FloatVector square = ratio.mul(ratio);
      FloatVector series =
          square.fma(ATAN_9, ATAN_7).fma(square, ATAN_5).fma(square, ATAN_3).mul(square);
      FloatVector angle = series.fma(ratio, ratio);
      angle = angle.blend(angle.add(QUARTER_PI), beyond);
      angle = angle.blend(HALF_PI.sub(angle), steep);
      angle = angle.blend(PI.sub(angle), x.compare(LT, ZERO));
      IntVector sign = y.reinterpretAsInts().and(SIGN_BIT);
      angle.reinterpretAsInts().or(sign).reinterpretAsFloats().intoArray(angles, i);
    }
  }

  /**
   * Replaces {@code count} numbers x, |x| up to 80, by e to the power x. Relative error below 2e-7;
   * exactly 1 at 0.
   *
   * @param count a multiple of {@link #LANES}
   */
  public static void exp(float[] values, int from, int count) {
    for (int i = from; i < from + count; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, values, i);
      FloatVector rounded = x.fma(LOG2_E, ROUND);
      FloatVector power = rounded.sub(ROUND);
      FloatVector rest = power.fma(LN_2_2, power.fma(LN_2_1, x));
      FloatVector series =
          rest.fma(EXP_7, EXP_6)
              .fma(rest, EXP_5)
              .fma(rest, EXP_4)
              .fma(rest, EXP_3)
              .fma(rest, EXP_2);
      IntVector fraction = series.fma(rest.mul(rest), rest.add(ONE)).reinterpretAsInts();
      fraction
          .add(rounded.reinterpretAsInts().lanewise(LSHL, 23))
          .reinterpretAsFloats()
          .intoArray(values, i);
    }
  }
}
