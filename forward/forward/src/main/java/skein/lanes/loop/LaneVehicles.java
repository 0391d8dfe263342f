package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.EQ;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.RolloutAgent;
import skein.lanes.plant.LaneSensors;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;
import skein.lanes.policy.VehicleNumbers;
import skein.vehicle.SensorNoise;

/** The vehicles of one role in many worlds, whose commands take effect at different times in each. Times
 * count from the start of a period; periods are processed in order. The subclasses {@link LagVehicles} and
 * {@link LaneFlights} differ in how they represent pending commands.
 */
public abstract class LaneVehicles {
  static final int WORLDS = LanePolicy.WORLDS;

  /** Offsets in {@link #state}, which is one array because passes over many arrays spend their time on
   * addresses. Position at the period's start, m; then position and velocity of the last reading, m and m/s;
   * each north, then east. In space follow position and velocity down of the last reading, and the position
   * down at the period's start. Components of a subclass begin at {@link #OWN}.
   */
  static final int X = 0,
      Y = WORLDS,
      SEEN_X = 2 * WORLDS,
      SEEN_Y = 3 * WORLDS,
      SEEN_VX = 4 * WORLDS,
      SEEN_VY = 5 * WORLDS,
      SEEN_Z = 6 * WORLDS,
      SEEN_VZ = 7 * WORLDS,
      Z = 8 * WORLDS,
      OWN = 9 * WORLDS;

  final float[] state;

  private final float[] kept;
  private final float[] startX = new float[WORLDS], startY = new float[WORLDS];

  final float[] startZ = new float[WORLDS];

  /** Whether commands and readings have a vertical part. */
  public final boolean inSpace;

  /** Errors of readings; null if these are true. The times of readings, ns, are negative where none is made.
   */
  private LaneSensors sensors;

  private final long[] sensedNs = new long[WORLDS];
  private int periodGrains;

  /** @param own number of the subclass's floats per world, from {@link #OWN} on */
  LaneVehicles(RolloutAgent agent, int own, boolean inSpace) {
    this.inSpace = inSpace;
    kept = new float[LaneObservation.count(true, inSpace) * WORLDS];
    state = new float[OWN + own * WORLDS];
    for (int world = 0; world < WORLDS; world++) place(world, agent);
  }

  private void place(int world, RolloutAgent agent) {
    startX[world] = (float) agent.startX();
    startY[world] = (float) agent.startY();
    startZ[world] = (float) agent.altitudeDownM();
  }

  /** Sets the start of a world's vehicle for all following episodes. */
  public final void place(int world, VehicleNumbers numbers) {
    startX[world] = numbers.northM();
    startY[world] = numbers.eastM();
    startZ[world] = numbers.downM();
  }

  /** Resets to the start of an episode, where the vehicles rest. */
  void start() {
    Arrays.fill(state, 0f);
    for (int x : new int[] {X, SEEN_X}) System.arraycopy(startX, 0, state, x, WORLDS);
    for (int y : new int[] {Y, SEEN_Y}) System.arraycopy(startY, 0, state, y, WORLDS);
    for (int z : new int[] {Z, SEEN_Z}) System.arraycopy(startZ, 0, state, z, WORLDS);
  }

  /** Reads the vehicles in worlds where {@code fresh} is 1, or, if that is null, in worlds where a view was
   * joined.
   *
   * @param vectors the vectors with such a world
   * @param joined time of the view; {@link LaneOffers#NONE} in worlds without a view
   * @param at time of the reading, in grains from the period's start
   */
  abstract void read(
      int row, LaneVectors vectors, int[] joined, int[] at, int[] fresh, boolean withVelocity);

  public final void senseBy(SensorNoise noise, double periodS) {
    sensors = new LaneSensors(noise, inSpace);
    periodGrains = LaneViews.grains(periodS);
  }

  final boolean isSensed() {
    return sensors != null;
  }

  /** Sets the seeds of the errors of the next episode's readings, if there are any.
   *
   * @param vehicle index of these vehicles
   */
  final void seed(int[] worldKeys, int vehicle) {
    if (sensors != null) sensors.start(Arrays.stream(worldKeys).asLongStream().toArray(), vehicle, false);
  }

  /** Reads the vehicles as {@link #read} does, with the errors of their sensors. */
  final void sense(
      int row, LaneVectors vectors, int[] joined, int[] at, int[] fresh, boolean withVelocity) {
    read(row, vectors, joined, at, fresh, withVelocity);
    if (sensors == null) return;
    long begin = (long) row * periodGrains;
    for (int k = 0; k < vectors.count; k++) {
      int from = vectors.first[k], to = from + LANES;
      boolean any = false;
      for (int i = from; i < to; i++) {
        boolean is = fresh == null ? joined[i] != LaneOffers.NONE : fresh[i] > 0;
        any |= is;
        sensedNs[i] = is ? (begin + at[i]) * LaneViews.GRAIN_NS : -1;
      }
      if (any) sense(from, to, withVelocity);
    }
  }

  private void sense(int from, int to, boolean withVelocity) {
    sensors.at(sensedNs, from, to);
    // The reading has the errors of the one before.
    if (inSpace && !climbs())
      for (int i = from; i < to; i++)
        if (sensedNs[i] >= 0) {
          state[SEEN_Z + i] = startZ[i];
          state[SEEN_VZ + i] = 0f;
        }
    for (int read = 0; read < LaneObservation.count(withVelocity, inSpace); read++)
      sensors.add(LaneSensors.componentOf(read), sensedNs, from, to, state, SEEN_X + read * WORLDS);
  }

  /** Whether the vehicles' plant has a vertical part. */
  boolean climbs() {
    return inSpace;
  }

  /** Simulates up to a period's start.
   *
   * @param isLookedAt whether the positions at that time are used
   */
  abstract void flyToRow(int row, boolean isLookedAt);

  /** Makes commands take effect, in each world no earlier than the previous command.
   *
   * @param vectors the vectors with a command
   * @param acts time at which it takes effect, in grains from the period's start; {@link LaneOffers#NONE} in
   *   worlds without a command
   */
  abstract void act(int row, LaneVectors vectors, int[] acts, Directions commanded);

  /** Returns the vehicles' positions at recent moments, without changing the last readings.
   *
   * @param vectors the vectors with a requested moment
   * @param at the moment, in grains from the period's start; {@link LaneOffers#NONE} in worlds without one
   * @param north receives positions north, m; {@code east} those east
   */
  final void look(int row, LaneVectors vectors, int[] at, float[] north, float[] east) {
    remember();
    read(row, vectors, at, at, null, false);
    System.arraycopy(state, SEEN_X, north, 0, WORLDS);
    System.arraycopy(state, SEEN_Y, east, 0, WORLDS);
    System.arraycopy(kept, 0, state, SEEN_X, kept.length);
  }

  final void remember() {
    System.arraycopy(state, SEEN_X, kept, 0, kept.length);
  }

  /** Restores the {@link #remember remembered} readings in worlds where {@code fresh} is 0. */
  final void keep(int[] fresh) {
    for (int i = 0; i < WORLDS; i += LANES) {
      VectorMask<Float> isOld = IntVector.fromArray(INTS, fresh, i).compare(EQ, 0).cast(SPECIES);
      if (isOld.anyTrue())
        for (int from = i; from < kept.length; from += WORLDS)
          FloatVector.fromArray(SPECIES, kept, from).intoArray(state, SEEN_X + from, isOld);
    }
  }
}
