package skein.simd;

import static jdk.incubator.vector.VectorOperators.LSHL;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorSpecies;

/** Primitives of SIMD passes over floats: the lane count, and powers of 2 by a polynomial. Results have
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

  public static final float LOG2_E = 1.44269504f;

  // 2^x = 2^k 2^r. Minimax of 2^r on ±1/2, 1 at 0,
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
}
