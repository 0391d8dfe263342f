package skein.lanes

import skein.forward.RolloutAgent
import skein.lanes.policy.TeamLanes
import skein.lanes.score.ScoreLanes

/** What teams have in common that fly side by side.
  *
  * @param altitudesDownM of the vehicles
  */
private[lanes] final case class TeamForm(
    team: TeamLanes,
    scores: ScoreLanes,
    durationS: Double,
    altitudesDownM: Vector[Double]
)(val vehicles: LaneDynamics):
  /** Whether decisions are to be told more than readings and their own times. */
  def asksMore: Boolean = team.asksMore.contains(true)

/** A candidate with the numbers that it differs by from others of its form.
  *
  * @param form none if no lanes fly it
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
