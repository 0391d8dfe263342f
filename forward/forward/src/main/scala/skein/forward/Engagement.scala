package skein.forward

import skein.policy.{Assignment, Fleet, Role}

/** Vehicles in one plane, as a rollout flies them: pursuers and evaders, 1 against 1 up to M against N, or a
  * team without sides. Each plays against the rival that the assignment gives it, as seen at its decision, or
  * regards the whole team, as its policy is. Whoever was captured flies on.
  *
  * @param roles of the agents, in the order in which a loop asks them
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

  /** Whose outcomes are told: the evaders; of a team without sides, everybody. */
  val judged: Vector[Int] = if bothSides then evaders else agents.indices.toVector

  /** To whom a judged one's distance is taken: the pursuers; in a team without sides, the others. */
  def against(one: Int): Vector[Int] = if bothSides then pursuers else judged.filter(_ != one)

object Engagement:
  /** Vehicles that one world holds. */
  val Most = 64

  /** The agents of a scenario, under its own assignment.
    *
    * @throws IllegalArgumentException if a policy may do what forward simulation does not fly: something else
    *   than a horizontal velocity at the altitude of the start
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

  /** A duel; the evader is asked first. */
  def of(duel: Duel): Engagement =
    Engagement(
      Vector(duel.evader, duel.pursuer),
      Vector(Role.Evader, Role.Pursuer),
      Assignment(Vector(Vector(1), Vector(0))),
      duel.durationS
    )
