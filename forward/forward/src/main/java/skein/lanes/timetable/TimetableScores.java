package skein.lanes.timetable;

/** Accumulates the scores of many worlds, once a period. */
public interface TimetableScores {
  /** Resets to the start of an episode.
   *
   * @param worlds number of worlds that count, from the first
   */
  void start(int worlds);

  /** Scores the present positions of all vehicles.
   *
   * @param agents by the vehicle's number
   * @param views of the timetable; the scored one begins at {@code view}
   */
  void score(TimetableAgents[] agents, int[] views, int view, float timeS);
}
