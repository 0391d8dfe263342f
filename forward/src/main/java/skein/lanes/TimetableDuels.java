package skein.lanes;

import skein.forward.Duel;
import skein.forward.LoopTiming;

/** Duels by {@link TimetableKernel}: the evader is vehicle 0. */
final class TimetableDuels extends DuelKernel {
  private final TimetableKernel kernel;
  private final LaneScores scores;

  /**
   * @param duel start, speeds and duration; its policies are not used
   * @param model the same as the timetables'
   * @param pursuerPolicy takes the parameters of each candidate's pursuer before it flies
   */
  TimetableDuels(
      Duel duel,
      LoopTiming timing,
      LaneDynamics model,
      LanePolicy pursuerPolicy,
      LanePolicy evaderPolicy) {
    this(duel, timing, model, pursuerPolicy, evaderPolicy, null, null);
  }

  /**
   * @param pursuerEye by which alone the pursuer knows of the evader; null for one that is told
   */
  TimetableDuels(
      Duel duel,
      LoopTiming timing,
      LaneDynamics model,
      LanePolicy pursuerPolicy,
      LanePolicy evaderPolicy,
      EyeLanes pursuerEye,
      EyeLanes evaderEye) {
    scores = new LaneScores(duel.durationS(), timing.periodS(), this);
    DuelAgents
        evader =
            new DuelAgents(
                0, duel.evader(), model, evaderPolicy, evaderEffortRad, new LaneObservation(), false, evaderEye),
        pursuer =
            new DuelAgents(
                1, duel.pursuer(), model, pursuerPolicy, pursuerEffortRad, new LaneObservation(), false, pursuerEye);
    kernel = new TimetableKernel(new TimetableAgents[] {evader, pursuer}, scores);
  }

  /**
   * Flies {@link #WORLDS} candidates through one episode, by the policies' parameters.
   *
   * @param worlds those that count are the first
   * @param captureRadiusM a distance of at most this is a capture
   */
  void fly(Timetable timetable, int worlds, float captureRadiusM) {
    scores.captureWithin(captureRadiusM);
    kernel.fly(timetable, worlds);
  }
}
