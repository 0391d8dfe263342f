package skein.lanes

import skein.forward.RolloutAgent
import skein.lanes.loop.{LaneAgents, LoopEye, LoopLanes}
import skein.lanes.policy.{CameraTrackerLanes, LanePolicy, OpponentLanes}
import skein.lanes.timetable.TimetableEye

/** Makes the vehicles of two opponents in many worlds. */
private[lanes] object Opponents:
  type NewEye =
    (CameraTrackerLanes.Forms, RolloutAgent, RolloutAgent, LoopLanes, LaneAgents, LaneAgents) => LoopEye

  def policiesOf(two: OpponentLanes): Vector[LanePolicy] = two.forms.zip(two.withEffort).map(LanePolicy(_, _))

  /** The two vehicles, with equal delays in all worlds.
    *
    * @param agents the vehicles; their speeds and first headings apply to all worlds
    * @param eyes the camera of each vehicle that knows its opponent only through it
    */
  def inEpisode(
      agents: Vector[RolloutAgent],
      models: Vector[LaneDynamics],
      policies: Vector[LanePolicy],
      eyes: Map[Int, TimetableEye]
  ): Array[OpponentAgents] = Array.tabulate(2): self =>
    val eye = eyes.getOrElse(self, null)
    OpponentAgents(self, agents(self), models(self), policies(self), eye)

  def eyesOf(two: OpponentLanes): Map[Int, TimetableEye] =
    two.cameras.map((self, forms) => self -> TimetableEye(forms, two.agents(self), two.agents(1 - self)))

  /** The two vehicles, with separate delays in every world.
    *
    * @param agents the vehicles; their speeds and first headings apply to all worlds
    * @param cameras the vehicles' cameras; at most one of the two has one
    */
  def inLoop(
      agents: Vector[RolloutAgent],
      loop: LoopLanes,
      models: Vector[LaneDynamics],
      policies: Vector[LanePolicy],
      cameras: Map[Int, CameraTrackerLanes.Forms],
      newEye: NewEye = LoopEye(_, _, _, _, _, _)
  ): (Array[LoopOpponentAgents], Option[LoopEye]) =
    val two = Array.tabulate(2): self =>
      LoopOpponentAgents(self, agents(self), loop, models(self), policies(self))
    val eye = cameras.headOption.map: (self, forms) =>
      val seen = newEye(forms, agents(self), agents(1 - self), loop, two(self), two(1 - self))
      two(self).seeBy(seen)
      seen
    (two, eye)
