package skein.lanes

import skein.forward.{Duel, RolloutAgent, TabledDelays}
import skein.lanes.loop.{LaneAgents, LoopEye, LoopKernel, LoopLanes}
import skein.lanes.policy.{CameraTrackerLanes, LanePolicy}

/** Simulates duels by [[LoopKernel]].
  *
  * @param duel start, speeds and duration; its policies are not used
  * @param model one that [[LoopSupport]] does not refuse
  * @param pursuers hold the parameters of each world's pursuer
  * @param asked the numbers to compute
  * @param eyes of one of the two at most
  */
private[lanes] final class LoopDuelKernel(
    duel: Duel,
    loop: LoopLanes,
    model: LaneDynamics,
    pursuers: LanePolicy,
    evaders: LanePolicy,
    asked: Set[DuelNumber],
    eyes: DuelEyes = DuelEyes.Nobody,
    newEye: LoopDuelKernel.NewEye = LoopEye(_, _, _, _, _, _)
) extends DuelKernel(duel.durationS, loop.periodS, asked):

  private val evader  = LoopDuelAgents(0, duel.evader, loop, model, evaders, evaderEffortRad)
  private val pursuer = LoopDuelAgents(1, duel.pursuer, loop, model, pursuers, pursuerEffortRad)

  private val eye: Option[LoopEye] =
    eyes.evader.map(newEye(_, duel.evader, duel.pursuer, loop, evader, pursuer)).orElse:
      eyes.pursuer.map(newEye(_, duel.pursuer, duel.evader, loop, pursuer, evader))
  for seen <- eye do (if eyes.evader.isDefined then evader else pursuer).seeBy(seen)

  private val kernel = LoopKernel(loop, Array(evader, pursuer), scores)

  /** Simulates one episode in each of [[DuelKernel.WORLDS]] worlds.
    *
    * @param keys [[skein.simd.WorldRandom.key]] of each world
    * @param links of each world; none may be slower than the loop was made for
    * @param captureRadiusM greatest distance that counts as a capture
    */
  def fly(keys: Array[Int], links: Array[TabledDelays], captureRadiusM: Float): Unit =
    captureWithin(captureRadiusM)
    eye.foreach(_.start(keys, links))
    kernel.fly(keys, links)

private[lanes] object LoopDuelKernel:
  type NewEye =
    (CameraTrackerLanes.Forms, RolloutAgent, RolloutAgent, LoopLanes, LaneAgents, LaneAgents) => LoopEye
