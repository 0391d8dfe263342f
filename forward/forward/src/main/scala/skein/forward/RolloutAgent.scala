package skein.forward

import skein.fusion.SensorModel
import skein.policy.{Agent, Policy}
import skein.vehicle.VehicleKind

/** One vehicle of a duel or of a team in a rollout.
  *
  * @param speed magnitude of the commanded velocity, unless the policy chooses one, m/s
  * @param startX the start, north, m
  * @param startY the start, east, m
  * @param altitudeDownM z of the start, and of the whole flight if the vehicle flies level, world NED, m
  * @param startHeadingRad heading assumed as the command before the first decision, from north
  * @param policy must be a pure function; [[VelocityResponse.performs]] limits its actions
  * @param eye camera that is the vehicle's only source about its one opponent, if any
  * @param kind the kind of vehicle; a car drives like [[CarResponse]], whatever the kind of the other
  *   vehicles
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
  /** The agent for a scenario's vehicle.
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
