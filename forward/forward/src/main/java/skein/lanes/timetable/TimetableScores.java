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
   * @param agents in the order of the vehicles' numbers
   * @param views all views of the timetable; the one to score begins at index {@code view}
   */
  void score(TimetableAgents[] agents, int[] views, int view, float timeS);

  /** Whether {@link #end} needs the velocities of readings. */
  default boolean needsVelocity() {
    return false;
  }

  /** Ends the worlds in which the flight is over by what is known now.
   *
   * @param view the index of the newest readings
   * @param sinceS time since the first decision
   * @param agesS of the readings, from index {@code ages} on
   */
  default void end(
      TimetableAgents[] agents, int[] views, int view, float timeS, float sinceS, float[] agesS, int ages) {
    throw new UnsupportedOperationException("worlds without an end of their own");
  }
}
