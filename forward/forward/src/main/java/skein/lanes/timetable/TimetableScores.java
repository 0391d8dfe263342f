package skein.lanes.timetable;

/** Adds up what many worlds come to, once a period. */
public interface TimetableScores {
  /**
   * Back to the start of an episode.
   *
   * @param worlds those that count are the first
   */
  void start(int worlds);

  /**
   * Where all vehicles are now.
   *
   * @param agents by the vehicle's number
   * @param views of the timetable; that which is scored begins at {@code view}
   */
  void score(TimetableAgents[] agents, int[] views, int view, float timeS);
}
