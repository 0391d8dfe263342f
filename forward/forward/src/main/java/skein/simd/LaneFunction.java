package skein.simd;

/**
 * A compiled formula: the same arithmetic in {@link #COUNT} worlds, several at a time. Made by {@link
 * LaneCompiler}. It keeps nothing between calls.
 */
public abstract class LaneFunction {
  /** Worlds computed by one call: a multiple of every lane count, few enough for the first-level cache. */
  public static final int COUNT = 128;

  /**
   * So many numbers at the begin of scratch and of parameters are unused. Else the index of the first would
   * be the loop's counter with nothing added, which the JVM's compiler may take for the loop's end; then it
   * peels the loop, for 14 s with some expressions.
   */
  static final int UNUSED = LaneMath.LANES;

  /** How many numbers {@link #apply} needs to lay results by. */
  public abstract int scratch();

  /** Whether it is one pass: then its outputs may lie where its inputs do. */
  public abstract boolean isOnePass();

  /**
   * Where a world's parameter stands among all: those of worlds that are computed together are one
   * stretch, for a pass through many that are used once reads them as fast as memory comes.
   *
   * @param count of parameters that each world has
   */
  public static int place(int parameter, int world, int count) {
    int lane = world % LaneMath.LANES;
    return UNUSED + (world - lane) * count + parameter * LaneMath.LANES + lane;
  }

  /** How many numbers hold the parameters of all worlds, of which each has so many. */
  public static int places(int count) {
    return UNUSED + COUNT * count;
  }

  /**
   * @param arrays of the inputs in their order, then of the outputs; unused ones may be null. An
   *     output must not lie where an input does, unless the function {@link #isOnePass is one pass},
   *     or nothing reads that input but the output itself and what it is computed of.
   * @param offsets where in its array each begins
   * @param parameters at their {@link #place places}; where all worlds have the same, one after the other
   * @param scratch of {@link #scratch()} numbers
   * @param worlds those that count are the first
   */
  public abstract void apply(
      float[][] arrays, int[] offsets, float[] parameters, float[] scratch, int worlds);

  /** The same for all worlds. */
  public final void apply(float[][] arrays, int[] offsets, float[] parameters, float[] scratch) {
    apply(arrays, offsets, parameters, scratch, COUNT);
  }
}
