package skein.forward

import skein.policy.{Assignment, Fleet, Role}

/** Vehicles in one plane, as a rollout simulates them: pursuers and evaders, 1 against 1 up to M against N,
  * or a team without sides. Depending on its policy, each considers the rival assigned to it at its decision,
  * or the whole team. A captured vehicle continues to fly.
  *
  * @param roles of the agents, in the order in which a loop reads them
  */
final case class Engagement(
    agents: Vector[RolloutAgent],
    roles: Vector[Role],
    assignment: Assignment,
    durationS: Double = 60.0
):
  require(
    agents.size == roles.size && agents.size == assignment.rivals.size,
    s"${agents.size} agents, ${roles.size} roles, rivals of ${assignment.rivals.size}"
  )
  require(
    agents.size >= 2 && agents.size <= Engagement.Most,
    s"expected 2 to ${Engagement.Most} agents, came ${agents.size}"
  )

  val evaders: Vector[Int]  = roles.indices.filter(roles(_) == Role.Evader).toVector
  val pursuers: Vector[Int] = roles.indices.filter(roles(_) == Role.Pursuer).toVector
  private val bothSides     = evaders.nonEmpty && pursuers.nonEmpty
  private val inSides       = evaders.size + pursuers.size
  require(
    inSides == 0 || bothSides && inSides == agents.size,
    s"expected pursuers and evaders, or neither, came ${roles.mkString(", ")}"
  )

  /** The agents with outcomes: the evaders; in a team without sides, all. */
  val judged: Vector[Int] = if bothSides then evaders else agents.indices.toVector

  /** The agents from which an agent's distance is measured: the pursuers; in a team without sides, the
    * others.
    */
  def against(one: Int): Vector[Int] = if bothSides then pursuers else judged.filter(_ != one)

object Engagement:
  val Most = 64

  /** The agents of a scenario, under its own assignment.
    *
    * @throws IllegalArgumentException if a policy may choose an action that forward simulation does not
    *   support: anything but a horizontal velocity at the altitude of the start
    */
  def of(fleet: Fleet, durationS: Double = 60.0): Engagement =
    val agents = fleet.agents.map(RolloutAgent.of)
    for (agent, self) <- agents.zipWithIndex do
      for reason <- Level.refusal(agent.policy, self, fleet.assignment, agent.altitudeDownM) do
        throw IllegalArgumentException(s"vehicle ${fleet.agents(self).name}: $reason")
    Engagement(
      agents,
      fleet.agents.map(_.role),
      fleet.assignment,
      durationS
    )

  /** The agents of a duel; the evader is read first. */
  def of(duel: Duel): Engagement =
    Engagement(
      Vector(duel.evader, duel.pursuer),
      Vector(Role.Evader, Role.Pursuer),
      Assignment(Vector(Vector(1), Vector(0))),
      duel.durationS
    )
