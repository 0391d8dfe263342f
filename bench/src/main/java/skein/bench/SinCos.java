package skein.bench;

import static jdk.incubator.vector.VectorOperators.LSHL;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.ROUND;
import static skein.simd.LaneMath.SPECIES;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;

/** Hand-written sines and cosines, by the polynomials that {@code skein.simd} compiles into formulas. */
public final class SinCos {
  private SinCos() {}

  private static final float TWO_OVER_PI = 0.63661977f;

  // −π/2 in three parts, the first two short enough for exact products (Cody and Waite; parts from
  // Cephes' sinf.c).
  private static final float HALF_PI_1 = -1.5703125f;
  private static final float HALF_PI_2 = -4.837512969970703e-4f;
  private static final float HALF_PI_3 = -7.549789948768648e-8f;

  // Minimax on ±π/4, from Cephes' sinf.c.
  private static final float SIN_3 = -1.6666654611e-1f;
  private static final float SIN_5 = 8.3321608736e-3f;
  private static final float SIN_7 = -1.9515295891e-4f;
  private static final float COS_2 = -0.5f;
  private static final float COS_4 = 4.166664568298827e-2f;
  private static final float COS_6 = -1.388731625493765e-3f;
  private static final float COS_8 = 2.443315711809948e-5f;

  /**
   * Sines and cosines of the first {@code count} angles, rad, |angle| up to 8192. Absolute error
   * below 1e-7 to ±π, below 3e-7 to ±8192.
   *
   * @param count a multiple of {@link #LANES}
   */
  public static void sinCos(float[] angles, float[] sines, float[] cosines, int count) {
    FloatVector twoOverPi = FloatVector.broadcast(SPECIES, TWO_OVER_PI),
        round = FloatVector.broadcast(SPECIES, ROUND),
        halfPi1 = FloatVector.broadcast(SPECIES, HALF_PI_1),
        halfPi2 = FloatVector.broadcast(SPECIES, HALF_PI_2),
        halfPi3 = FloatVector.broadcast(SPECIES, HALF_PI_3),
        sin3 = FloatVector.broadcast(SPECIES, SIN_3),
        sin5 = FloatVector.broadcast(SPECIES, SIN_5),
        sin7 = FloatVector.broadcast(SPECIES, SIN_7),
        cos2 = FloatVector.broadcast(SPECIES, COS_2),
        cos4 = FloatVector.broadcast(SPECIES, COS_4),
        cos6 = FloatVector.broadcast(SPECIES, COS_6),
        cos8 = FloatVector.broadcast(SPECIES, COS_8),
        one = FloatVector.broadcast(SPECIES, 1f);
    IntVector intOne = IntVector.broadcast(INTS, 1),
        intTwo = IntVector.broadcast(INTS, 2),
        intZero = IntVector.broadcast(INTS, 0);
    for (int i = 0; i < count; i += LANES) {
      FloatVector angle = FloatVector.fromArray(SPECIES, angles, i);
      FloatVector rounded = angle.fma(twoOverPi, round);
      FloatVector quarters = rounded.sub(round);
      FloatVector rest =
          quarters.fma(halfPi3, quarters.fma(halfPi2, quarters.fma(halfPi1, angle)));
      FloatVector square = rest.mul(rest);
      FloatVector sin = square.fma(sin7, sin5).fma(square, sin3).mul(square).fma(rest, rest);
      FloatVector cos =
          square.fma(cos8, cos6).fma(square, cos4).fma(square, cos2).fma(square, one);
      IntVector quadrant = rounded.reinterpretAsInts();
      VectorMask<Float> odd = quadrant.lanewise(LSHL, 31).compare(LT, intZero).cast(SPECIES);
      // Quadrants 2 and 3 negate the sine, 1 and 2 the cosine.
      IntVector sinSign = quadrant.and(intTwo).lanewise(LSHL, 30);
      IntVector cosSign = quadrant.add(intOne).and(intTwo).lanewise(LSHL, 30);
      sin.blend(cos, odd)
          .reinterpretAsInts()
          .lanewise(XOR, sinSign)
          .reinterpretAsFloats()
          .intoArray(sines, i);
      cos.blend(sin, odd)
          .reinterpretAsInts()
          .lanewise(XOR, cosSign)
          .reinterpretAsFloats()
          .intoArray(cosines, i);
    }
  }
}
