package skein.forward

import skein.fusion.SensorModel
import skein.policy.{Agent, Policy}
import skein.vehicle.VehicleKind

/** One vehicle of a duel or of a team in a rollout.
  *
  * @param speed of the commanded velocity, where its policy does not choose one, m/s
  * @param startX north, m
  * @param startY east, m
  * @param altitudeDownM z of its start, and of the whole flight where it flies level, world NED, m
  * @param startHeadingRad assumed command before its first decision, from north
  * @param policy must be a pure function; [[VelocityResponse]] says which actions it may choose
  * @param eye the camera that is its only knowledge of its one opponent, if any
  * @param kind a car drives as [[CarResponse]] does, whatever the others are
  */
final case class RolloutAgent(
    speed: Double,
    startX: Double,
    startY: Double,
    altitudeDownM: Double,
    startHeadingRad: Double,
    policy: Policy,
    eye: Option[SensorModel] = None,
    kind: VehicleKind = VehicleKind.Multirotor
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
      agent.policy,
      kind = agent.kind
    )
