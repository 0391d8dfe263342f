package skein.forward

import skein.fusion.SensorModel
import skein.policy.{Agent, Policy, TeamPolicy}

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
final case class RolloutAgent(
    speed: Double,
    startX: Double,
    startY: Double,
    altitudeDownM: Double,
    startHeadingRad: Double,
    policy: Policy | TeamPolicy,
    eye: Option[SensorModel] = None
)

object RolloutAgent:
  /** An agent of a scenario. */
  def of(agent: Agent): RolloutAgent = RolloutAgent(
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
