package skein.lanes

import skein.forward.{Duel, TabledDelays}

/** Duels by [[LoopKernel]].
  *
  * @param duel start, speeds and duration; its policies are not used
  * @param model one that [[LoopSupport]] does not refuse
  * @param pursuers take the parameters of each world's pursuer before it flies
  * @param asked what they are judged by
  */
private[lanes] final class LoopDuelKernel(
    duel: Duel,
    loop: LoopLanes,
    model: LaneDynamics,
    pursuers: LanePolicy,
    evaders: LanePolicy,
    asked: Set[DuelNumber]
) extends DuelKernel(duel.durationS, loop.periodS, asked):

  private val kernel = LoopKernel(
    loop,
    Array(
      LoopDuelAgents(0, duel.evader, loop, model, evaders, evaderEffortRad),
      LoopDuelAgents(1, duel.pursuer, loop, model, pursuers, pursuerEffortRad)
    ),
    scores
  )

  /** Flies one episode in each of [[DuelKernel.WORLDS]] worlds.
    *
    * @param keys [[skein.simd.WorldRandom.key]] of each world
    * @param links of each world; none may be slower than the loop was made for
    * @param captureRadiusM a distance of at most this is a capture
    */
  def fly(keys: Array[Int], links: Array[TabledDelays], captureRadiusM: Float): Unit =
    captureWithin(captureRadiusM)
    kernel.fly(keys, links)
