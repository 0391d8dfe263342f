package skein.simd;

/** A compiled formula: equal arithmetic in {@link #COUNT} worlds, by SIMD. {@link LaneCompiler} makes it.
 * Stateless between calls.
 */
public abstract class LaneFunction {
  /** Number of worlds of one call: a multiple of every lane count, small enough for the first-level cache. */
  public static final int COUNT = 128;

  /** Number of unused entries at the start of scratch and of parameters. Otherwise the index of the first
   * entry would be the loop's counter with nothing added, which the JIT compiler may mistake for the loop's
   * end; then it peels the loop, for 14 s with some expressions.
   */
  static final int UNUSED = LaneMath.LANES;

  /** Number of scratch floats that {@link #apply} needs. */
  public abstract int scratch();

  /** Whether it is a single pass: then its outputs may overwrite its inputs. */
  public abstract boolean isOnePass();

  /** Offset of a world's parameter among all: parameters of worlds that are computed together are contiguous,
   * because a pass over many values that are used once then reads at memory speed.
   *
   * @param count of parameters per world
   */
  public static int place(int parameter, int world, int count) {
    int lane = world % LaneMath.LANES;
    return UNUSED + (world - lane) * count + parameter * LaneMath.LANES + lane;
  }

  /** Number of floats for the parameters of all worlds. */
  public static int places(int count) {
    return UNUSED + COUNT * count;
  }

  /** Evaluates the formula.
   *
   * @param arrays of the inputs in their order, then of the outputs; unused ones may be null. An output must
   *   not overlap an input, unless the function {@link #isOnePass is one pass}, or only that output's
   *   computation reads that input
   * @param offsets of each in its array
   * @param parameters at their {@link #place places}; consecutive where all worlds share them
   * @param scratch of {@link #scratch()} numbers
   * @param worlds number of worlds that count, from the first
   */
  public abstract void apply(
      float[][] arrays, int[] offsets, float[] parameters, float[] scratch, int worlds);

  /** Evaluates the formula for all {@link #COUNT} worlds. */
  public final void apply(float[][] arrays, int[] offsets, float[] parameters, float[] scratch) {
    apply(arrays, offsets, parameters, scratch, COUNT);
  }
}
