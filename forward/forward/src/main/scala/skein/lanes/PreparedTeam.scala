package skein.lanes

import skein.forward.RolloutAgent
import skein.lanes.policy.TeamLanes
import skein.lanes.score.ScoreLanes

/** What teams that are simulated side by side have in common.
  *
  * @param altitudesDownM of vehicles that fly level
  */
private[lanes] final case class TeamForm(
    team: TeamLanes,
    scores: ScoreLanes,
    durationS: Double,
    altitudesDownM: Vector[Double]
)(val vehicles: LaneDynamics):
  def inSpace: Boolean = team.inSpace

  /** Whether decisions need more than readings and their own times. */
  def asksMore: Boolean = team.asksMore.contains(true)

/** A candidate with the numbers by which it differs from others of its form.
  *
  * @param form None if SIMD does not support it
  * @param steps whether its vehicles are stepped side by side instead
  */
private[lanes] final class PreparedTeam(
    val candidate: TeamCandidate,
    val form: Option[TeamForm],
    steps: => Boolean
):
  lazy val isStepped: Boolean        = steps
  def vehicles: Vector[RolloutAgent] = candidate.engagement.agents

  val ofPolicies: Vector[MemberNumbers] = form.toVector.flatMap: form =>
    vehicles.zipWithIndex.map: (agent, self) =>
      MemberNumbers(form.team.parametersOf(self, agent.policy), form.team.startOf(self, agent.policy))
  val ofQuantities: Vector[Array[Double]] = form.toVector.flatMap: form =>
    candidate.judged.zipWithIndex.map((each, number) => form.scores.parametersOf(number, each.quantity))
