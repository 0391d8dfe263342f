package skein.lanes.timetable;

import skein.lanes.policy.Directions;
import skein.lanes.policy.LanePolicy;

/** One vehicle of a {@link Timetable} in many worlds, with its policies. Subclasses make the decisions on a
 * view.
 */
public abstract class TimetableAgents {
  public static final int WORLDS = LanePolicy.WORLDS;

  public final TimetableVehicles vehicles;

  /** Decided directions, or velocities divided by the vehicles' speed, indexed by slot. */
  public final Directions headings;

  public TimetableAgents(TimetableVehicles vehicles) {
    this.vehicles = vehicles;
    headings = new Directions(0, vehicles.inSpace());
  }

  /** Resets to the start of an episode.
   *
   * @param worlds number of worlds that count, from the first
   */
  public void start(Timetable timetable, int worlds) {
    vehicles.start(timetable.readings(), worlds);
    headings.reserve(timetable.headings() * WORLDS);
    if (vehicles.inSpace()) headings.level(vehicles.startZ);
  }

  public abstract boolean needsVelocity();

  /** Decides in all worlds.
   *
   * @param all agents, indexed by vehicle
   * @param views all views of the timetable; that of the decision begins at {@code view}
   * @param known the index, for the first world, of the opponent's last known heading in a duel
   * @param before the index of the vehicle's previous heading, and {@code after} that of the decided one
   * @param times the decision's times in the timetable, from {@code number} on
   */
  public abstract void decide(
      TimetableAgents[] all,
      int[] views,
      int view,
      int known,
      int before,
      int after,
      float[] times,
      int number);

  /** Computes the memory after a decision in all worlds, without deciding: what a policy that is decided from
   * outside observes. The arguments are those of {@link #decide}.
   */
  public abstract void observe(
      TimetableAgents[] all, int[] views, int view, int known, int before, float[] times, int number);

  /** Takes an image in all worlds, if this vehicle has a camera.
   *
   * @param view the index of the readings that it shows
   * @param times the image's times in the timetable, from {@code number} on
   */
  public void expose(TimetableAgents[] all, int[] views, int view, int image, float[] times, int number) {
    throw new UnsupportedOperationException("a vehicle without eyes");
  }

  /** Updates the estimate with an image, in all worlds.
   *
   * @param isOlder whether it was taken before the last one that became known
   */
  public void join(int image, boolean isOlder, int last) {
    throw new UnsupportedOperationException("a vehicle without eyes");
  }
}
