package skein.simd;

import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.NE;

import jdk.incubator.vector.DoubleVector;
import jdk.incubator.vector.LongVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorSpecies;
import skein.signal.NormalQuantile;
import skein.signal.SplitMix64;

/** Random numbers of {@link SplitMix64}, and normal deviates from them by {@link NormalQuantile}, equal to
 * the bit.
 */
public final class LaneNormals {
  private LaneNormals() {}

  public static final VectorSpecies<Long> LONGS = LongVector.SPECIES_PREFERRED;

  private static final VectorSpecies<Double> DOUBLES = DoubleVector.SPECIES_PREFERRED;

  /** The multipliers of {@link SplitMix64#mix}. */
  public static final long MULTIPLIER_1 = 0xbf58476d1ce4e5b9L, MULTIPLIER_2 = 0x94d049bb133111ebL;

  /** Half of the probability beyond the central part of {@link NormalQuantile}. */
  private static final double TAIL = 0.02425;

  private static final double LEAST = 1e-12, STEP = 0x1p-53;

  private static final long ONE = Double.doubleToRawLongBits(1.0);

  /** Computes the normal deviates of random numbers; a probability below 10⁻¹² counts as that.
   *
   * @param to end of the range, at a multiple of {@link #LONGS}' length from {@code from}
   */
  public static void of(long[] bits, int from, int to, double[] into) {
    LongVector one = LongVector.broadcast(LONGS, ONE), lowest = LongVector.broadcast(LONGS, 1L << 11);
    for (int i = from; i < to; i += LONGS.length()) {
      LongVector drawn = LongVector.fromArray(LONGS, bits, i);
      // 52 bits as a number from 1 to 2, and the 53rd bit apart: there is no conversion on every machine.
      DoubleVector p = drawn.lanewise(LSHR, 12).or(one).reinterpretAsDoubles().sub(1.0);
      p = p.add(STEP, drawn.and(lowest).compare(NE, 0L).cast(DOUBLES));
      DoubleVector q = p.sub(0.5), r = q.mul(q);
      DoubleVector above =
          r.mul(-3.969683028665376e1)
              .add(2.209460984245205e2)
              .mul(r)
              .sub(2.759285104469687e2)
              .mul(r)
              .add(1.383577518672690e2)
              .mul(r)
              .sub(3.066479806614716e1)
              .mul(r)
              .add(2.506628277459239);
      DoubleVector below =
          r.mul(-5.447609879822406e1)
              .add(1.615858368580409e2)
              .mul(r)
              .sub(1.556989798598866e2)
              .mul(r)
              .add(6.680131188771972e1)
              .mul(r)
              .sub(1.328068155288572e1)
              .mul(r)
              .add(1.0);
      q.mul(above).div(below).intoArray(into, i);
      VectorMask<Double> isCentral = p.compare(GE, TAIL).and(p.compare(LE, 1 - TAIL));
      for (long tails = isCentral.not().toLong(); tails != 0; tails &= tails - 1) {
        int at = i + Long.numberOfTrailingZeros(tails);
        into[at] = NormalQuantile.apply(Math.max((bits[at] >>> 11) * STEP, LEAST));
      }
    }
  }
}
