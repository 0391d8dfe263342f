package skein.forward

import skein.fusion.SensorModel
import skein.policy.{Agent, Policy}

/** One vehicle of a duel or of a team in a rollout.
  *
  * @param speed of the commanded velocity, where its policy does not choose one, m/s
  * @param startX north, m
  * @param startY east, m
  * @param altitudeDownM z of the whole flight, world NED, m
  * @param startHeadingRad assumed command before its first decision, from north
  * @param policy one that chooses horizontal velocities at that altitude; must be a pure function
  * @param eye the camera that is its only knowledge of its one opponent, if any
  */
final case class RolloutAgent(
    speed: Double,
    startX: Double,
    startY: Double,
    altitudeDownM: Double,
    startHeadingRad: Double,
    policy: Policy,
    eye: Option[SensorModel] = None
)

object RolloutAgent:
  /** An agent of a scenario.
    *
    * @throws IllegalArgumentException if its policy reads sensors, which forward simulation does not have
    */
  def of(agent: Agent): RolloutAgent =
    require(
      agent.policy.sensors.isEmpty,
      s"vehicle ${agent.name}: its policy reads ${agent.policy.sensors.toSeq.sorted.mkString(", ")}, and " +
        "forward simulation has no sensors"
    )
    RolloutAgent(
      agent.speed.value,
      agent.startPositionNed.x,
      agent.startPositionNed.y,
      agent.startPositionNed.z,
      agent.startHeading.value,
      agent.policy
    )
