package skein.lanes;

/** Adds up what many worlds come to, once a period. */
interface TimetableScores {
  /** Back to the start of an episode. */
  void start();

  /**
   * Where all vehicles are now.
   *
   * @param agents by the vehicle's number
   * @param views of the timetable; that which is scored begins at {@code view}
   * @param isLast whether it counts for the mean of the last 10 s
   */
  void score(TimetableAgents[] agents, int[] views, int view, boolean isLast, float timeS);

  /** At the end of the episode. */
  void finish();
}
