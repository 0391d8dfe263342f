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
}
