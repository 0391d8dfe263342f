package skein.lanes

import skein.forward.{Duel, LoopTiming}
import skein.lanes.policy.{LaneObservation, LanePolicy}
import skein.lanes.timetable.{Timetable, TimetableEye, TimetableKernel}

/** Duels by [[TimetableKernel]]: the evader is vehicle 0. Mutable.
  *
  * @param duel start, speeds and duration; its policies are not used
  * @param model the same as the timetables'
  * @param pursuerPolicy takes the parameters of each candidate's pursuer before it flies
  * @param asked what they are judged by
  * @param pursuerEye by which alone the pursuer knows of the evader; null for one that is told
  */
private[lanes] final class TimetableDuels(
    duel: Duel,
    timing: LoopTiming,
    model: LaneDynamics,
    pursuerPolicy: LanePolicy,
    evaderPolicy: LanePolicy,
    asked: Set[DuelNumber] = DuelNumber.all,
    pursuerEye: TimetableEye = null,
    evaderEye: TimetableEye = null
) extends DuelKernel(duel.durationS, timing.periodS, asked):
  private val kernel = TimetableKernel(
    Array(
      DuelAgents(0, duel.evader, model, evaderPolicy, evaderEffortRad, LaneObservation(), false, evaderEye),
      DuelAgents(
        1,
        duel.pursuer,
        model,
        pursuerPolicy,
        pursuerEffortRad,
        LaneObservation(),
        false,
        pursuerEye
      )
    ),
    scores
  )

  /** Flies [[DuelKernel.WORLDS]] candidates through one episode, by the policies' parameters.
    *
    * @param worlds those that count are the first
    * @param captureRadiusM a distance of at most this is a capture
    */
  def fly(timetable: Timetable, worlds: Int, captureRadiusM: Float): Unit =
    captureWithin(captureRadiusM)
    kernel.fly(timetable, worlds)
