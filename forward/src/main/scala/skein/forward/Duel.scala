package skein.forward

import skein.fusion.SensorModel
import skein.policy.{Agent, Fleet, Policy, Role, TeamPolicy}
import skein.scenario.PaperDuel

/** One vehicle of a duel or of a team, as a rollout flies it.
  *
  * @param speed of the velocity it commands, where its policy does not choose one, m/s
  * @param startX north, m
  * @param startY east, m
  * @param altitudeDownM z of the whole flight, world NED, m
  * @param startHeadingRad which it is taken to have been commanded before its first decision, from north
  * @param policy see [[skein.policy.Policy]], and [[skein.policy.TeamPolicy]] for engagements; must be a pure
  *   function
  * @param eye by which alone it knows of its one opponent, if it is not told
  */
final case class Duelist(
    speed: Double,
    startX: Double,
    startY: Double,
    altitudeDownM: Double,
    startHeadingRad: Double,
    policy: Policy | TeamPolicy,
    eye: Option[SensorModel] = None
)

object Duelist:
  /** An agent of a scenario. */
  def of(agent: Agent): Duelist = Duelist(
    agent.speed.value,
    agent.startPositionNed.x,
    agent.startPositionNed.y,
    agent.startPositionNed.z,
    agent.startHeading.value,
    agent.policy match
      case planar: (Policy | TeamPolicy) => planar
      case _                             =>
        throw IllegalArgumentException(
          s"vehicle ${agent.name}: forward simulation flies headings, not this policy"
        )
  )

/** @param durationS of an episode
  */
final case class Duel(pursuer: Duelist, evader: Duelist, durationS: Double = 60.0)

object Duel:
  /** The duel of a scenario with one pursuer and one evader. */
  def of(fleet: Fleet, durationS: Double = 60.0): Duel =
    require(fleet.agents.size == 2, s"a duel has two agents, this fleet ${fleet.agents.size}")
    def the(role: Role) =
      val agent = fleet.agents.find(_.role == role).get
      Duelist.of(agent).copy(policy = agent.duelPolicy)
    Duel(the(Role.Pursuer), the(Role.Evader), durationS)

  val paper: Duel = of(PaperDuel().fleet)

  /** The paper's duel at another altitude. */
  def paperAt(altitudeM: Double, durationS: Double): Duel =
    of(PaperDuel(altitudeM = altitudeM).fleet, durationS)

/** What an episode came to. Distances are horizontal, taken once a period.
  *
  * @param captureS when the distance first was at most the capture radius; infinite if never
  * @param pursuerEffortRad control effort: the sum of all changes of the commanded heading, by the shorter
  *   way
  * @param evaderEffortRad the same of the evader
  * @param decisions of both agents
  * @param skipped views on which an agent did not decide because a newer one came first
  */
final case class DuelOutcome(
    minDistanceM: Double,
    minDistanceAtS: Double,
    meanDistanceM: Double,
    meanLast10sM: Double,
    captureS: Double,
    pursuerEffortRad: Double,
    evaderEffortRad: Double,
    decisions: Int,
    skipped: Int
)

/** What an episode came to for one evader; distances are to the nearest pursuer, once a period.
  *
  * @param captureS when the distance first was at most the capture radius; infinite if never
  */
final case class EvaderOutcome(
    minDistanceM: Double,
    minDistanceAtS: Double,
    meanDistanceM: Double,
    meanLast10sM: Double,
    captureS: Double
)
