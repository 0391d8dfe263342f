package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import jdk.incubator.vector.IntVector;
import skein.forward.DelayTable;
import skein.forward.TabledDelays;
import skein.lanes.policy.LanePolicy;

/** The offers to the vehicles' controllers in many worlds: views of the readings, on which they may decide.
 * Each loop has another order of messages. Offers do not depend on decisions, so they are computed ahead. The
 * reference are the loops of {@code Rollout}.
 *
 * <p>Worlds advance through the flight period by period, together. Each period has rounds ("beats") of
 * offers: of each world and agent at most one, none earlier than one of an earlier round. While some world
 * has an offer in the period, others may already have theirs of {@link #rowsAhead} later periods, so that
 * nearly all worlds have one in every round. Times are in {@link DelayTable#GrainNs} from the period's start.
 */
public abstract class LaneOffers {
  static final int WORLDS = LanePolicy.WORLDS;

  static final int ALL = -1;

  public static final int NONE = LaneViews.NONE;

  final LaneDelays delays;

  final int vehicles;

  /** Whether every offer is made to all vehicles. */
  final boolean together;

  /** Number of later periods whose offers a round may contain. */
  final int rowsAhead;

  public int beat;

  int whose = ALL;

  /** The offers of the round: when each is made ({@link #NONE} in worlds without), and when the next one is.
   */
  public int[] joinedAt, nextAt;

  final int[][] sampledAt;

  /** By vehicle: 1 where the reading differs from the one before; null where all do. */
  final int[][] fresh;

  /** By agent: the step to which its command belongs, as places of the random sequence from the period's. */
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

  /** Makes arrays for the offers of a round, for loops in which all offers of a world belong to one step.
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

  /** Moves to a period; periods are processed in order, from 0. */
  abstract void startRow(int row);

  /** Moves to the next round of the period, if it has one. */
  abstract boolean nextBeat();

  /** Whether the offers of the round are made to a vehicle's controller. */
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
