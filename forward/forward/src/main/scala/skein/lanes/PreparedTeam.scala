package skein.lanes

import skein.forward.RolloutAgent
import skein.lanes.policy.TeamLanes
import skein.lanes.score.ScoreLanes
import skein.policy.TeamPolicy

/** What teams have in common that fly side by side.
  *
  * @param altitudesDownM of the vehicles
  */
private[lanes] final case class TeamForm(
    team: TeamLanes,
    scores: ScoreLanes,
    durationS: Double,
    altitudesDownM: Vector[Double]
)(val vehicles: LaneDynamics)

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

  val ofPolicies: Vector[Array[Double]] = form.toVector.flatMap: form =>
    vehicles.zipWithIndex.map((agent, self) =>
      form.team.parametersOf(self, agent.policy.asInstanceOf[TeamPolicy])
    )
  val ofQuantities: Vector[Array[Double]] = form.toVector.flatMap: form =>
    candidate.judged.zipWithIndex.map((each, number) => form.scores.parametersOf(number, each.quantity))
