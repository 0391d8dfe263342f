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
import skein.lanes.policy.Directions;
import skein.lanes.policy.LanePolicy;

/**
 * The vehicles of one role in many worlds, whose commands act at times of their own in each. Times
 * count from the begin of a period; periods are taken in turn. {@link LagVehicles} and {@link
 * LaneFlights} are the two ways to keep what has not acted yet.
 */
public abstract class LaneVehicles {
  static final int WORLDS = LanePolicy.WORLDS;

  /**
   * Where each world's numbers begin in {@link #state}: position at the period's begin, m; position and
   * velocity as read last, m and m/s; north, then east. The kind of vehicle may keep more from {@link
   * #OWN} on: passes over many arrays spend their time on their addresses.
   */
  static final int X = 0,
      Y = WORLDS,
      SEEN_X = 2 * WORLDS,
      SEEN_Y = 3 * WORLDS,
      SEEN_VX = 4 * WORLDS,
      SEEN_VY = 5 * WORLDS,
      OWN = 6 * WORLDS;

  final float[] state;

  private final float[] kept = new float[4 * WORLDS];
  private final float[] startX = new float[WORLDS], startY = new float[WORLDS];

  /**
   * @param own numbers of each world that the kind of vehicle keeps from {@link #OWN} on
   */
  LaneVehicles(RolloutAgent agent, int own) {
    state = new float[OWN + own * WORLDS];
    for (int world = 0; world < WORLDS; world++) place(world, agent);
  }

  /** Takes where a world's vehicle starts from now on. */
  public final void place(int world, RolloutAgent agent) {
    startX[world] = (float) agent.startX();
    startY[world] = (float) agent.startY();
  }

  /** Back to the start of an episode, where they rest. */
  void start() {
    Arrays.fill(state, 0f);
    for (int x : new int[] {X, SEEN_X}) System.arraycopy(startX, 0, state, x, WORLDS);
    for (int y : new int[] {Y, SEEN_Y}) System.arraycopy(startY, 0, state, y, WORLDS);
  }

  /**
   * Reads the vehicles where {@code fresh} is 1, or wherever something was joined.
   *
   * @param vectors in which some world is read
   * @param joined less than {@link LaneOffers#NONE} where something was
   * @param at when they are read, from the row's begin, in grains
   */
  abstract void read(
      int row, LaneVectors vectors, int[] joined, int[] at, int[] fresh, boolean withVelocity);

  /**
   * Flies to a row's begin.
   *
   * @param isLookedAt whether somebody looks at where they are then
   */
  abstract void flyToRow(int row, boolean isLookedAt);

  /**
   * Lets commands act, none earlier than the one before.
   *
   * @param vectors in which some command does
   * @param acts when, from the row's begin, in grains; {@link LaneOffers#NONE} where none does
   */
  abstract void act(int row, LaneVectors vectors, int[] acts, Directions commanded);

  /**
   * Tells where the vehicles were at moments of the near past, and leaves what was read last as it is.
   *
   * @param vectors in which somebody asks
   * @param at when, from the row's begin, in grains; {@link LaneOffers#NONE} where nobody asks
   * @param north and {@code east}: positions, m
   */
  final void look(int row, LaneVectors vectors, int[] at, float[] north, float[] east) {
    remember();
    read(row, vectors, at, at, null, false);
    System.arraycopy(state, SEEN_X, north, 0, WORLDS);
    System.arraycopy(state, SEEN_Y, east, 0, WORLDS);
    System.arraycopy(kept, 0, state, SEEN_X, kept.length);
  }

  /** Keeps what was read before. */
  final void remember() {
    System.arraycopy(state, SEEN_X, kept, 0, kept.length);
  }

  /** Puts back what was {@link #remember remembered} where nothing is fresh. */
  final void keep(int[] fresh) {
    for (int i = 0; i < WORLDS; i += LANES) {
      VectorMask<Float> isOld = IntVector.fromArray(INTS, fresh, i).compare(EQ, 0).cast(SPECIES);
      if (isOld.anyTrue())
        for (int from = i; from < kept.length; from += WORLDS)
          FloatVector.fromArray(SPECIES, kept, from).intoArray(state, SEEN_X + from, isOld);
    }
  }
}
