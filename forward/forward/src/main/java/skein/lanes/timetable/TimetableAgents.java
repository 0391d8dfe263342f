package skein.lanes.timetable;

import skein.lanes.policy.Directions;
import skein.lanes.policy.LanePolicy;

/**
 * One vehicle of a {@link Timetable} in many worlds, and who decides for it. A kind of agents says
 * how decisions are made upon a view.
 */
public abstract class TimetableAgents {
  public static final int WORLDS = LanePolicy.WORLDS;

  public final TimetableVehicles vehicles;

  /** Decided directions, or velocities over the vehicles' speed, by place. */
  public final Directions headings = new Directions(0);

  public TimetableAgents(TimetableVehicles vehicles) {
    this.vehicles = vehicles;
  }

  /**
   * Back to the start of an episode.
   *
   * @param worlds those that count are the first
   */
  public void start(Timetable timetable, int worlds) {
    vehicles.start(timetable.readings(), worlds);
    headings.reserve(timetable.headings() * WORLDS);
  }

  /** Whether decisions look at velocities. */
  public abstract boolean needsVelocity();

  /**
   * Decides in all worlds.
   *
   * @param all agents, by the vehicle's number
   * @param views of the timetable; that which is decided upon begins at {@code view}
   * @param known in a duel, the index of the first world's heading of the opponent, as far as known
   * @param before the same of the own heading before, and {@code after} of the decided one
   * @param times from {@code number} on, what the timetable tells of the decision
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

  /**
   * Takes an image in all worlds, if this vehicle sees.
   *
   * @param view the index of the readings that it shows
   * @param times from {@code number} on, what the timetable tells of the image
   */
  public void expose(TimetableAgents[] all, int[] views, int view, int image, float[] times, int number) {
    throw new UnsupportedOperationException("a vehicle without eyes");
  }

  /**
   * What an image showed is known in all worlds.
   *
   * @param isOlder whether it was taken before the one that was known last
   */
  public void join(int image, boolean isOlder, int last) {
    throw new UnsupportedOperationException("a vehicle without eyes");
  }
}
