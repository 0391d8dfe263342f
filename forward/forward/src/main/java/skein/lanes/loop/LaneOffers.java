package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import jdk.incubator.vector.IntVector;
import skein.forward.DelayTable;
import skein.forward.TabledDelays;
import skein.lanes.policy.LanePolicy;

/** Computes the offers to the vehicles' controllers in many worlds. An offer is a view of the readings, on
 * which a vehicle may decide. Each loop exchanges messages in another order and has its own subclass. Offers
 * do not depend on decisions, so they are computed ahead. The scalar references are the loops of {@code
 * Rollout}.
 *
 * <p>All worlds advance together, period by period. Each period has rounds ("beats"): a round contains at
 * most one offer per world and agent, none earlier than the offers of the round before. A round may contain
 * offers of up to {@link #rowsAhead} later periods, so that nearly every world has an offer in every round.
 * Times are in {@link DelayTable#GrainNs} from the period's start.
 */
public abstract class LaneOffers {
  static final int WORLDS = LanePolicy.WORLDS;

  static final int ALL = -1;

  public static final int NONE = LaneViews.NONE;

  final LaneDelays delays;

  final int vehicles;

  final MissingReadings missing;

  /** Whether an offer goes to all vehicles, or else to one. */
  final boolean together;

  /** Number of later periods whose offers may be in a round. */
  final int rowsAhead;

  public int beat;

  int whose = ALL;

  /** The times of this round's offers and of the next offers, by world; {@link #NONE} without an offer. */
  public int[] joinedAt, nextAt;

  final int[][] sampledAt;

  /** Of each vehicle, 1 in worlds where the offer has a new reading of it, else 0; null if all readings are
   * new.
   */
  final int[][] fresh;

  /** Of each agent, the index of its command in the random sequence: that of the step to which the command
   * belongs, relative to that of the period.
   */
  final int[][] place;

  LaneOffers(
      int vehicles, LaneDelays delays, MissingReadings missing, boolean together, int rowsAhead) {
    this.vehicles = vehicles;
    this.missing = missing;
    sampledAt = new int[vehicles][];
    fresh = new int[vehicles][];
    place = new int[vehicles][];
    this.together = together;
    this.rowsAhead = rowsAhead;
    this.delays = delays;
  }

  /** Allocates arrays for the offers of a round; for loops in which all offers of a world belong to one step.
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

  /** Whether the offers of this round go to a vehicle's controller. */
  final boolean isFor(int vehicle) {
    return whose == ALL || whose == vehicle;
  }

  /** Whether no world has a time in a slot.
   *
   * @param times the times, indexed by vehicle, slot and world
   */
  static boolean isEmpty(int[][][] times, int slot) {
    for (int[][] each : times) if (isBefore(each[slot], NONE)) return false;
    return true;
  }

  /** Whether some world's time is before {@code time}. */
  static boolean isBefore(int[] times, int time) {
    IntVector before = IntVector.broadcast(INTS, time);
    for (int i = 0; i < WORLDS; i += LANES)
      if (IntVector.fromArray(INTS, times, i).compare(LT, before).anyTrue()) return true;
    return false;
  }
}
