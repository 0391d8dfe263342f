package skein.simd;

import static jdk.incubator.vector.VectorOperators.LSHL;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorSpecies;

/** Primitives of SIMD passes over floats: the lane count, and the exponential by polynomials. Results have
 * identical bits in every lane, on every machine and at every lane count. {@code LaneMathSuite} tests the
 * error bounds.
 *
 * <p>Kernels are written as passes over blocks of worlds. The compiler stops inlining methods of ours once a
 * compilation reaches 18,000 nodes, some 60 vector operations, and a vector that crosses a call is boxed,
 * which costs a factor of ten; methods of the vector API itself it always inlines. So a pass calls none of
 * our methods; then it may be long. A constant vector is an object whose lanes are read from memory in every
 * round, since a pass's stores might have changed them: a loop's constants are broadcast before it. A vector
 * that a loop carries must start as a computed vector; a constant would be boxed.
 */
public final class LaneMath {
  private LaneMath() {}

  /** The machine's preferred lanes. Results do not depend on their number. */
  public static final VectorSpecies<Float> SPECIES = FloatVector.SPECIES_PREFERRED;

  public static final VectorSpecies<Integer> INTS = IntVector.SPECIES_PREFERRED;

  public static final int LANES = SPECIES.length();

  public static final FloatVector ZERO = constant(0f);
  public static final FloatVector ONE = constant(1f);

  /** 1.5·2²³: adding it leaves a float's nearest integer in its lowest bits. */
  public static final float ROUND = 12582912f;

  // e^x = 2^k e^r: log₂ e, −ln 2 in two parts, and the series of e^r on ±ln 2 / 2, from Cephes'
  // expf.c.
  public static final float LOG2_E = 1.44269504f;
  private static final float LN_2_1 = -0.693359375f;
  private static final float LN_2_2 = 2.12194440e-4f;
  private static final float EXP_2 = 5.0000001201e-1f;
  private static final float EXP_3 = 1.6666665459e-1f;
  private static final float EXP_4 = 4.1665795894e-2f;
  private static final float EXP_5 = 8.3334519073e-3f;
  private static final float EXP_6 = 1.3981999507e-3f;
  private static final float EXP_7 = 1.9875691500e-4f;

  // For passes that need an exponential of only a few values: 2^x = 2^k 2^r. Minimax of 2^r on ±1/2, 1 at 0,
  // relative error 9.2e-8; the error of x, times ln 2, adds to it.
  public static final float POWER_1 = 0.693147f;
  public static final float POWER_2 = 0.24022242f;
  public static final float POWER_3 = 0.055507336f;
  public static final float POWER_4 = 0.009671513f;
  public static final float POWER_5 = 0.0013264727f;

  /** Smallest exponent of two; lower exponents count as this. Floats have hardly any smaller powers. */
  public static final float LEAST_POWER = -120f;

  /** 2 to the power of each lane, with exponents below {@link #LEAST_POWER} raised to it. Relative error
   * below 2e-7; exactly 1 at 0.
   */
  public static FloatVector powerOf2(FloatVector exponent) {
    FloatVector rounded = exponent.add(ROUND);
    FloatVector rest = exponent.sub(rounded.sub(ROUND)), square = rest.mul(rest);
    FloatVector power1 = FloatVector.broadcast(SPECIES, POWER_1),
        power2 = FloatVector.broadcast(SPECIES, POWER_2),
        power3 = FloatVector.broadcast(SPECIES, POWER_3),
        power4 = FloatVector.broadcast(SPECIES, POWER_4),
        power5 = FloatVector.broadcast(SPECIES, POWER_5);
    return rest.fma(power5, power4)
        .fma(square, rest.fma(power3, power2))
        .fma(square, rest.fma(power1, FloatVector.broadcast(SPECIES, 1f)))
        .reinterpretAsInts()
        .add(rounded.reinterpretAsInts().lanewise(LSHL, 23))
        .reinterpretAsFloats();
  }

  /** A vector with this value in every lane, for static constants. */
  public static FloatVector constant(float value) {
    return FloatVector.broadcast(SPECIES, value);
  }

  /** Replaces {@code count} numbers x, |x| up to 80, by e to the power of x. Relative error below 2e-7;
   * exactly 1 at 0.
   *
   * @param count a multiple of {@link #LANES}
   */
  public static void exp(float[] values, int from, int count) {
    FloatVector log2E = FloatVector.broadcast(SPECIES, LOG2_E),
        round = FloatVector.broadcast(SPECIES, ROUND),
        ln21 = FloatVector.broadcast(SPECIES, LN_2_1),
        ln22 = FloatVector.broadcast(SPECIES, LN_2_2),
        exp2 = FloatVector.broadcast(SPECIES, EXP_2),
        exp3 = FloatVector.broadcast(SPECIES, EXP_3),
        exp4 = FloatVector.broadcast(SPECIES, EXP_4),
        exp5 = FloatVector.broadcast(SPECIES, EXP_5),
        exp6 = FloatVector.broadcast(SPECIES, EXP_6),
        exp7 = FloatVector.broadcast(SPECIES, EXP_7),
        one = FloatVector.broadcast(SPECIES, 1f);
    for (int i = from; i < from + count; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, values, i);
      FloatVector rounded = x.fma(log2E, round);
      FloatVector power = rounded.sub(round);
      FloatVector rest = power.fma(ln22, power.fma(ln21, x));
      FloatVector series =
          rest.fma(exp7, exp6)
              .fma(rest, exp5)
              .fma(rest, exp4)
              .fma(rest, exp3)
              .fma(rest, exp2);
      IntVector fraction = series.fma(rest.mul(rest), rest.add(one)).reinterpretAsInts();
      fraction
          .add(rounded.reinterpretAsInts().lanewise(LSHL, 23))
          .reinterpretAsFloats()
          .intoArray(values, i);
    }
  }
}
