package skein.simd;

/** A formula compiled to SIMD code, which evaluates it in {@link #COUNT} worlds with equal arithmetic. {@link
 * LaneCompiler} creates it. Stateless between calls.
 */
public abstract class LaneFunction {
  /** Number of worlds per call: a multiple of every lane count, and small enough for the first-level cache.
   */
  public static final int COUNT = 128;

  /** Number of unused entries at the start of scratch and of parameters. Without them the first entry's index
   * would be the loop counter itself. The JIT compiler may mistake it for the loop's end and peel the loop,
   * which takes 14 s with some expressions.
   */
  static final int UNUSED = LaneMath.LANES;

  /** Number of scratch floats that {@link #apply} needs. */
  public abstract int scratch();

  /** Whether the function is a single pass, whose outputs may overwrite its inputs. */
  public abstract boolean isOnePass();

  /** Index of a world's parameter. Parameters of worlds that are computed together are contiguous, so that a
   * pass over many values that are used once reads at memory speed.
   *
   * @param count number of parameters per world
   */
  public static int place(int parameter, int world, int count) {
    int lane = world % LaneMath.LANES;
    return UNUSED + (world - lane) * count + parameter * LaneMath.LANES + lane;
  }

  /** Number of floats for all worlds' parameters. */
  public static int places(int count) {
    return UNUSED + COUNT * count;
  }

  /** Evaluates the formula.
   *
   * @param arrays the inputs in their order, then the outputs; unused entries may be null. An output may
   *   overlap an input only if the function {@link #isOnePass is one pass}, or if no other output depends on
   *   that input
   * @param offsets the offset of each argument in its array
   * @param parameters the parameters, indexed by {@link #place}; consecutive if all worlds share them
   * @param scratch array of {@link #scratch()} floats
   * @param worlds number of worlds to evaluate, from the first
   */
  public abstract void apply(
      float[][] arrays, int[] offsets, float[] parameters, float[] scratch, int worlds);

  /** Evaluates the formula for all {@link #COUNT} worlds. */
  public final void apply(float[][] arrays, int[] offsets, float[] parameters, float[] scratch) {
    apply(arrays, offsets, parameters, scratch, COUNT);
  }
}
