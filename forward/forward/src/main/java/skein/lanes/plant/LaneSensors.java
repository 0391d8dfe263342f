package skein.lanes.plant;

import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneNormals.LONGS;
import static skein.simd.LaneNormals.MULTIPLIER_1;
import static skein.simd.LaneNormals.MULTIPLIER_2;

import java.util.Arrays;
import jdk.incubator.vector.LongVector;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;
import skein.signal.SplitMix64;
import skein.simd.LaneNormals;
import skein.vehicle.NoisySensor;
import skein.vehicle.SensorNoise;

/** The errors of readings of one vehicle in many worlds. The scalar reference is {@link NoisySensor}: from
 * equal seeds both draw equal numbers. Which readings are missing is decided elsewhere, since the loop
 * depends on it. Mutable.
 */
public final class LaneSensors {
  private static final int WORLDS = LanePolicy.WORLDS;

  /** Components of a reading: position and velocity, each north, east and down. */
  private static final int NORTH = 0, EAST = 1, DOWN = 2, NORTH_MPS = 3, EAST_MPS = 4, DOWN_MPS = 5;

  private static final int COMPONENTS = 6, AXES = 3;

  private static final int[] OF_READINGS = {NORTH, EAST, NORTH_MPS, EAST_MPS, DOWN, DOWN_MPS};

  /** The error of a component of readings, in the order of {@link LaneObservation#X} and the following. */
  public static int componentOf(int read) {
    return OF_READINGS[read];
  }

  private static final long GAMMA = SplitMix64.Gamma();

  private static final long TICK_NS = SensorNoise.Tick();

  /** Number of ticks whose drift is kept, a power of two: readings of one period lie closer together. */
  private static final int TICKS = 128;

  /** Standard deviations of white noise, by component, m and m/s. */
  private final double[] sd = new double[COMPONENTS];

  private final double driftM, keeps, renews;

  private final int axes;

  // The seeds by component and world, mixed as far as they do not depend on the time; and those of drifts.
  private final long[][] white = new long[COMPONENTS][WORLDS], drifts = new long[AXES][WORLDS];

  /** Drifts by axis, then tick modulo {@link #TICKS}, then world, m; and number of ticks so far. */
  private final double[][] drift;

  private int ticks;

  /** Whether all worlds have one seed and equal times; then their errors are computed once. */
  private boolean areOne;

  // Of the present readings, by world: the mixed time; the tick before, and the time since, in ticks.
  private final long[] times = new long[WORLDS];
  private final int[] tick = new int[WORLDS];
  private final double[] since = new double[WORLDS];

  private final long[] bits = new long[WORLDS];
  private final double[] errors = new double[WORLDS], drawn = new double[WORLDS];

  /** @param inSpace whether readings have a vertical part */
  public LaneSensors(SensorNoise noise, boolean inSpace) {
    axes = inSpace ? AXES : AXES - 1;
    Arrays.fill(sd, NORTH, NORTH_MPS, noise.positionM());
    Arrays.fill(sd, NORTH_MPS, COMPONENTS, noise.velocityMps());
    driftM = noise.driftM();
    keeps = StrictMath.exp(-(TICK_NS * 1e-9 / noise.driftS()));
    renews = driftM * Math.sqrt(1 - keeps * keeps);
    drift = new double[AXES][driftM == 0 ? 0 : TICKS * WORLDS];
  }

  /** Resets to the start of an episode.
   *
   * @param seeds of the worlds' errors
   * @param vehicle index of the vehicle
   * @param simultaneous whether readings are made simultaneously in all worlds
   */
  public void start(long[] seeds, int vehicle, boolean simultaneous) {
    areOne = simultaneous && Arrays.stream(seeds).allMatch(seed -> seed == seeds[0]);
    for (int world = 0; world < (areOne ? LONGS.length() : WORLDS); world++) {
      long seed = SplitMix64.seedOf(seeds[world], vehicle);
      for (int axis = 0; axis < AXES; axis++) {
        drifts[axis][world] = SplitMix64.seedOf(seed, axis);
        white[axis][world] = mixed(seed, NoisySensor.Positions() + axis);
        white[AXES + axis][world] = mixed(seed, NoisySensor.Velocities() + axis);
      }
    }
    ticks = 0;
  }

  private static long mixed(long seed, int quantity) {
    return SplitMix64.mix(SplitMix64.seedOf(seed, quantity) + GAMMA);
  }

  /** Prepares the errors of readings that are made simultaneously in all worlds.
   *
   * @param atNs time since the episode's start, ns
   */
  public void at(long atNs) {
    Arrays.fill(times, SplitMix64.mix(atNs * GAMMA + 1));
    if (driftM == 0) return;
    int before = (int) (atNs / TICK_NS);
    Arrays.fill(tick, before);
    Arrays.fill(since, sinceTick(atNs, before));
    drawTo(before + 1);
  }

  /** Prepares the errors of readings.
   *
   * @param atNs time of each since the episode's start, ns; negative without a reading
   * @param from first of these worlds, {@code to} the one after the last; multiples of the lane count
   */
  public void at(long[] atNs, int from, int to) {
    for (int i = from; i < to; i++) times[i] = SplitMix64.mix(atNs[i] * GAMMA + 1);
    if (driftM == 0) return;
    int last = 0;
    for (int i = from; i < to; i++)
      if (atNs[i] >= 0) {
        tick[i] = (int) (atNs[i] / TICK_NS);
        since[i] = sinceTick(atNs[i], tick[i]);
        last = Math.max(last, tick[i]);
        if (tick[i] < ticks - TICKS)
          throw new IllegalStateException("a reading is older than " + TICKS + " ticks of drift");
      }
    drawTo(last + 1);
  }

  private static double sinceTick(long atNs, int tick) {
    return (atNs - tick * TICK_NS) * 1e-9 / (TICK_NS * 1e-9);
  }

  /** Adds the errors to a component of readings, in the worlds with a reading.
   *
   * @param reading the component, for world 0 at index {@code at}
   */
  public void add(int component, long[] atNs, int from, int to, float[] reading, int at) {
    if (!draw(component, from, to)) return;
    for (int i = from; i < to; i++) if (atNs[i] >= 0) reading[at + i] += (float) errors[i];
  }

  /** Adds the errors to a component of readings, in all worlds. */
  public void add(int component, float[] reading, int at) {
    if (!draw(component, 0, areOne ? LONGS.length() : WORLDS)) return;
    if (areOne) Arrays.fill(errors, errors[0]);
    for (int i = 0; i < WORLDS; i++) reading[at + i] += (float) errors[i];
  }

  /** Computes {@link #errors} in a range of worlds; false, without any, if the component has none. */
  private boolean draw(int component, int from, int to) {
    boolean isWhite = sd[component] > 0, drifts = driftM > 0 && component < AXES;
    if (isWhite) {
      mix(white[component], from, to);
      LaneNormals.of(bits, from, to, errors);
      for (int i = from; i < to; i++) errors[i] *= sd[component];
    } else if (drifts) Arrays.fill(errors, from, to, 0);
    if (drifts) drift(drift[component], from, to);
    return isWhite || drifts;
  }

  private void drift(double[] values, int from, int to) {
    for (int i = from; i < to; i++) {
      double before = values[(tick[i] & TICKS - 1) * WORLDS + i],
          after = values[(tick[i] + 1 & TICKS - 1) * WORLDS + i];
      errors[i] += before + (after - before) * since[i];
    }
  }

  /** Mixes the worlds' seeds with the times, as a sequence's seed, and draws its first number. */
  private void mix(long[] seeds, int from, int to) {
    LongVector gamma = LongVector.broadcast(LONGS, GAMMA),
        multiplier1 = LongVector.broadcast(LONGS, MULTIPLIER_1),
        multiplier2 = LongVector.broadcast(LONGS, MULTIPLIER_2);
    for (int i = from; i < to; i += LONGS.length()) {
      LongVector z = LongVector.fromArray(LONGS, seeds, i).lanewise(XOR, LongVector.fromArray(LONGS, times, i));
      z = z.lanewise(XOR, z.lanewise(LSHR, 30)).mul(multiplier1);
      z = z.lanewise(XOR, z.lanewise(LSHR, 27)).mul(multiplier2);
      z = z.lanewise(XOR, z.lanewise(LSHR, 31)).add(gamma);
      z = z.lanewise(XOR, z.lanewise(LSHR, 30)).mul(multiplier1);
      z = z.lanewise(XOR, z.lanewise(LSHR, 27)).mul(multiplier2);
      z.lanewise(XOR, z.lanewise(LSHR, 31)).intoArray(bits, i);
    }
  }

  private void drawTo(int last) {
    int to = areOne ? LONGS.length() : WORLDS;
    for (; ticks <= last; ticks++)
      for (int axis = 0; axis < axes; axis++) {
        double[] values = drift[axis];
        long nth = (ticks + 1) * GAMMA;
        for (int i = 0; i < to; i++) bits[i] = SplitMix64.mix(drifts[axis][i] + nth);
        LaneNormals.of(bits, 0, to, drawn);
        int at = (ticks & TICKS - 1) * WORLDS, before = (ticks - 1 & TICKS - 1) * WORLDS;
        for (int i = 0; i < to; i++)
          values[at + i] =
              ticks == 0 ? driftM * drawn[i] : values[before + i] * keeps + renews * drawn[i];
      }
  }
}
