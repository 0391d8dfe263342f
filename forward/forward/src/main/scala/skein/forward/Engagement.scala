package skein.forward

import skein.fusion.SensorModel
import skein.policy.{Assignment, Fleet, Policy, Role}
import skein.scenario.{Known, OwnEnd, Scenario}
import skein.vehicle.VehicleKind

/** The vehicles of a rollout: pursuers and evaders, from one against one up to M against N, or a team without
  * sides. Depending on its policy, a vehicle considers either the rival that its assignment has for it at
  * that moment, or all other vehicles. A captured vehicle continues to fly.
  *
  * @param roles the agents' roles, in the order in which a loop reads the agents
  * @param isOver whether the engagement ends before its duration; evaluated at every decision
  */
final case class Engagement(
    agents: Vector[RolloutAgent],
    roles: Vector[Role],
    assignment: Assignment,
    durationS: Double = 60.0,
    isOver: Option[Known => Boolean] = None
):
  require(
    agents.size == roles.size && agents.size == assignment.rivals.size,
    s"${agents.size} agents, ${roles.size} roles, rivals of ${assignment.rivals.size}"
  )
  require(
    agents.nonEmpty && agents.size <= Engagement.Most,
    s"expected 1 to ${Engagement.Most} agents, got ${agents.size}"
  )

  private val count = Seq(Role.Evader, Role.Pursuer).map(role => roles.count(_ == role))
  require(
    count.sum == 0 || !count.contains(0) && count.sum == agents.size,
    s"expected pursuers and evaders, or neither, got ${roles.mkString(", ")}"
  )

  lazy val isTraced: Boolean =
    agents.indices.forall(self => Level.formula(agents(self).policy, self, assignment, false).isRight)

  /** Replaces the policy of all agents of a role. */
  def flownBy(role: Role, policy: Policy): Engagement = changed(role)(_.copy(policy = policy))

  /** Lets all agents of a role know their opponents only through a camera; without one, by readings. */
  def seeing(role: Role, eye: Option[SensorModel]): Engagement = changed(role)(_.copy(eye = eye))

  private def changed(role: Role)(change: RolloutAgent => RolloutAgent) =
    copy(agents = agents.zip(roles).map((agent, own) => if own == role then change(agent) else agent))

  lazy val hasCars: Boolean = agents.exists(_.kind == VehicleKind.Car)

  /** The reason why some vehicle may turn or may leave the altitude of its start; None if all fly level. */
  lazy val climbs: Option[String] = agents.indices.iterator
    .filter(agents(_).kind != VehicleKind.Car)
    .flatMap(self => Level.refusal(agents(self).policy, self, assignment, agents(self).altitudeDownM))
    .nextOption()

object Engagement:
  val Most = 64

  /** An engagement of a fleet that flies level, with the fleet's assignment.
    *
    * @throws IllegalArgumentException if a policy reads sensors, or may choose an action other than a
    *   horizontal velocity at the altitude of its start
    */
  def of(fleet: Fleet, durationS: Double = 60.0): Engagement =
    val flown = inSpace(fleet, durationS)
    for (agent, self) <- flown.agents.zipWithIndex do
      for reason <- Level.refusal(agent.policy, self, fleet.assignment, agent.altitudeDownM) do
        throw IllegalArgumentException(s"vehicle ${fleet.agents(self).name}: $reason")
    flown

  /** An engagement of a fleet, with the fleet's assignment.
    *
    * @throws IllegalArgumentException if a policy reads sensors
    */
  def inSpace(fleet: Fleet, durationS: Double = 60.0): Engagement =
    Engagement(fleet.agents.map(RolloutAgent.of), fleet.agents.map(_.role), fleet.assignment, durationS)

  /** An engagement of a scenario's vehicles, which ends when the scenario does, and after `durationS` at the
    * latest.
    *
    * @throws IllegalArgumentException if a policy reads sensors
    */
  def ofScenario(scenario: Scenario, durationS: Double): Engagement =
    inSpace(scenario.fleet, durationS).copy(isOver = OwnEnd.of(scenario))
