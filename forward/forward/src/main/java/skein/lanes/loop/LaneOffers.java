package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import jdk.incubator.vector.IntVector;
import skein.forward.DelayTable;
import skein.forward.TabledDelays;
import skein.lanes.policy.LanePolicy;

/**
 * What the controllers of vehicles are offered to decide upon, in many worlds: under each loop
 * another order of the same messages. Nothing of it depends on what is decided, so it is told ahead.
 * The reference are the loops of {@code Rollout}.
 *
 * <p>Worlds go through the flight period by period, together. Offers come in beats: of each world and
 * agent at most one, none of which is earlier than one of a beat before. While some world has an offer
 * in the period, others may have their next ones of {@link #rowsAhead} periods more: with that, nearly
 * all worlds have one in every beat. Times are in {@link DelayTable#GrainNs} from the period's begin.
 */
public abstract class LaneOffers {
  static final int WORLDS = LanePolicy.WORLDS;

  /** In the place of a vehicle: everyone. */
  static final int ALL = -1;

  /** In the place of a time: none. */
  public static final int NONE = LaneViews.NONE;

  final LaneDelays delays;

  final int vehicles;

  /** Whether every offer is made to all. */
  final boolean together;

  /** So many periods behind the present one, a beat may have offers of. */
  final int rowsAhead;

  /** How many beats there were. */
  public int beat;

  /** Whose beat it is. */
  int whose = ALL;

  /** The beat's offers: when each is made ({@link #NONE} in worlds without), and when the next one is. */
  public int[] joinedAt, nextAt;

  /** By vehicle: when it was read. */
  final int[][] sampledAt;

  /** By vehicle: 1 where the reading is another than before; null where they all are. */
  final int[][] fresh;

  /** By agent: the step that its command belongs to, in places of the random sequence from the period's. */
  final int[][] place;

  LaneOffers(int vehicles, LaneDelays delays, boolean together, int rowsAhead) {
    this.vehicles = vehicles;
    sampledAt = new int[vehicles][];
    fresh = new int[vehicles][];
    place = new int[vehicles][];
    this.together = together;
    this.rowsAhead = rowsAhead;
    this.delays = delays;
  }

  /**
   * Makes arrays for the beat's offers, for loops in which all offers of a world belong to one step.
   *
   * @param places for {@link #place}
   */
  final void keepOffers(int[] places) {
    joinedAt = new int[WORLDS];
    nextAt = new int[WORLDS];
    for (int v = 0; v < vehicles; v++) {
      sampledAt[v] = new int[WORLDS];
      place[v] = places;
    }
  }

  abstract void start(int[] worldKeys, TabledDelays[] links);

  /** To a period; they are taken in turn, from 0. */
  abstract void startRow(int row);

  /** To the next beat of the period, if it has one. */
  abstract boolean nextBeat();

  /** Whether the beat's offers are made to a vehicle's controller. */
  final boolean isFor(int vehicle) {
    return whose == ALL || whose == vehicle;
  }

  /** Whether no world has a time in a slot, of times by vehicle and slot. */
  static boolean isEmpty(int[][][] times, int slot) {
    for (int[][] each : times) if (isBefore(each[slot], NONE)) return false;
    return true;
  }

  /** Whether some world's time comes before another. */
  static boolean isBefore(int[] times, int time) {
    IntVector before = IntVector.broadcast(INTS, time);
    for (int i = 0; i < WORLDS; i += LANES)
      if (IntVector.fromArray(INTS, times, i).compare(LT, before).anyTrue()) return true;
    return false;
  }
}
