package skein.lanes

import skein.forward.{Duel, LoopTiming}
import skein.lanes.policy.{LaneObservation, LanePolicy}
import skein.lanes.timetable.{Timetable, TimetableEye, TimetableKernel}

/** Simulates duels by [[TimetableKernel]]: the evader is vehicle 0. Mutable.
  *
  * @param duel start, speeds and duration; its policies are not used
  * @param model the one of the timetables
  * @param pursuerPolicy holds the parameters of each candidate's pursuer
  * @param asked the numbers to compute
  * @param pursuerEye the camera that is the pursuer's only knowledge of the evader; null if it reads the
  *   evader's state
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

  /** Simulates [[DuelKernel.WORLDS]] candidates in one episode, by the policies' parameters.
    *
    * @param worlds number of worlds that count, from the first
    * @param captureRadiusM greatest distance that counts as a capture
    */
  def fly(timetable: Timetable, worlds: Int, captureRadiusM: Float): Unit =
    captureWithin(captureRadiusM)
    kernel.fly(timetable, worlds)
