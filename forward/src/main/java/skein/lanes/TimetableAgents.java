package skein.lanes;

/**
 * One vehicle of a {@link Timetable} in many worlds, and who decides for it. A kind of agents says
 * how decisions are made upon a view.
 */
abstract class TimetableAgents {
  static final int WORLDS = LanePolicy.WORLDS;

  final TimetableVehicles vehicles;

  /** Decided directions, or velocities over the vehicles' speed, by place. */
  final Directions headings = new Directions(0);

  TimetableAgents(TimetableVehicles vehicles) {
    this.vehicles = vehicles;
  }

  /**
   * Back to the start of an episode.
   *
   * @param worlds those that count are the first
   */
  void start(Timetable timetable, int worlds) {
    vehicles.start(timetable.readings(), worlds);
    headings.reserve(timetable.headings() * WORLDS);
  }

  /** Whether decisions look at velocities. */
  abstract boolean needsVelocity();

  /**
   * Decides in all worlds.
   *
   * @param all agents, by the vehicle's number
   * @param views of the timetable; that which is decided upon begins at {@code view}
   * @param known in a duel, the index of the first world's heading of the opponent, as far as known
   * @param before the same of the own heading before, and {@code after} of the decided one
   * @param times from {@code number} on, what the timetable tells of the decision
   */
  abstract void decide(
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
  void expose(TimetableAgents[] all, int[] views, int view, int image, float[] times, int number) {
    throw new UnsupportedOperationException("a vehicle without eyes");
  }

  /**
   * What an image showed is known in all worlds.
   *
   * @param isOlder whether it was taken before the one that was known last
   */
  void join(int image, boolean isOlder, int last) {
    throw new UnsupportedOperationException("a vehicle without eyes");
  }
}
