package skein.lanes

import skein.forward.RolloutAgent
import skein.lanes.loop.{LaneAgents, LoopEye, LoopLanes}
import skein.lanes.policy.{CameraTrackerLanes, LaneObservation, LanePolicy, OpponentLanes}
import skein.lanes.timetable.{TimetableAgents, TimetableEye}

/** Makes the vehicles of two that play against one another. */
private[lanes] object Opponents:
  type NewEye =
    (CameraTrackerLanes.Forms, RolloutAgent, RolloutAgent, LoopLanes, LaneAgents, LaneAgents) => LoopEye

  def policiesOf(two: OpponentLanes): Vector[LanePolicy] = two.forms.zip(two.withEffort).map(LanePolicy(_, _))

  /** With equal delays in all worlds.
    *
    * @param agents speeds and first headings
    * @param eyes by vehicle, the camera that is its only knowledge of its opponent
    */
  def inEpisode(
      agents: Vector[RolloutAgent],
      model: LaneDynamics,
      policies: Vector[LanePolicy],
      eyes: Map[Int, TimetableEye]
  ): Array[OpponentAgents] = Array.tabulate(2): self =>
    val eye = eyes.getOrElse(self, null)
    OpponentAgents(self, agents(self), model, policies(self), newEffort, LaneObservation(), eye)

  def eyesOf(two: OpponentLanes): Map[Int, TimetableEye] =
    two.cameras.map((self, forms) => self -> TimetableEye(forms, two.agents(self), two.agents(1 - self)))

  /** With separate delays in every world.
    *
    * @param agents speeds and first headings
    * @param cameras of one of the two at most
    */
  def inLoop(
      agents: Vector[RolloutAgent],
      loop: LoopLanes,
      model: LaneDynamics,
      policies: Vector[LanePolicy],
      cameras: Map[Int, CameraTrackerLanes.Forms],
      newEye: NewEye = LoopEye(_, _, _, _, _, _)
  ): (Array[LoopOpponentAgents], Option[LoopEye]) =
    val two = Array.tabulate(2): self =>
      LoopOpponentAgents(self, agents(self), loop, model, policies(self), newEffort)
    val eye = cameras.headOption.map: (self, forms) =>
      val seen = newEye(forms, agents(self), agents(1 - self), loop, two(self), two(1 - self))
      two(self).seeBy(seen)
      seen
    (two, eye)

  private def newEffort = Array.ofDim[Float](TimetableAgents.WORLDS)
