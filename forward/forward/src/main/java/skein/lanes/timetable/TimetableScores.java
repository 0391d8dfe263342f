package skein.lanes.timetable;

/** Accumulates the scores of many worlds, once a period. */
public interface TimetableScores {
  /** Resets to the start of an episode.
   *
   * @param worlds number of worlds to score, from the first
   */
  void start(int worlds);

  /** Scores the present positions of all vehicles.
   *
   * @param agents one per vehicle, in the vehicles' order
   * @param views all views of the timetable; the one to score begins at index {@code view}
   */
  void score(TimetableAgents[] agents, int[] views, int view, float timeS);

  /** Whether {@link #end} needs the velocities of readings. */
  default boolean needsVelocity() {
    return false;
  }

  /** Ends the worlds in which the flight has ended, given these readings.
   *
   * @param view the index of the newest readings
   * @param sinceS time since the first decision, s
   * @param agesS the readings' ages, s, from index {@code ages} on
   */
  default void end(
      TimetableAgents[] agents, int[] views, int view, float timeS, float sinceS, float[] agesS, int ages) {
    throw new UnsupportedOperationException("worlds without an end of their own");
  }
}
