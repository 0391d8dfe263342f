package skein.policy

import skein.units.*
import skein.vehicle.VehicleKind

/** One vehicle and its policy.
  *
  * @param name the simulator's name of the vehicle; in AirSim, that of `settings.json`
  * @param speed the commanded speed where the policy does not choose one
  * @param startPositionNed the start, m, in the world frame; the vehicle also holds this altitude, which for
  *   a car is 0
  * @param startHeading stands for the last commanded heading before the first decision
  * @param policy how it decides
  * @param kind the kind of vehicle; a car is steered in the plane or stands still
  */
final case class Agent(
    name: String,
    role: Role,
    speed: MetresPerSecond,
    startPositionNed: Vector3,
    startHeading: Radians,
    policy: Policy,
    kind: VehicleKind = VehicleKind.Multirotor
):
  /** The velocity to command for a heading, m/s, horizontal, world NED.
    *
    * @param chosen the speed, if the policy chose one
    */
  def velocityNed(headingRad: Double, chosen: Option[MetresPerSecond] = None): Vector3 =
    val commanded = chosen.getOrElse(speed).value
    Vector3(commanded * StrictMath.cos(headingRad), commanded * StrictMath.sin(headingRad), 0)

/** The agents of a scenario, as loops and forward simulation need them. The opponent of each is the nearest
  * agent of another role, or, if all roles are equal, the nearest agent; a single agent is its own opponent.
  */
final case class Fleet(agents: Vector[Agent]):
  private val opponents = agents.indices.toVector.map: self =>
    val others = agents.indices.filter(_ != self).toVector
    val rivals = others.filter(agents(_).role != agents(self).role)
    if agents(self).policy.isAgainstOne then rivals
    else Vector(rivals, others, Vector(self)).find(_.nonEmpty).getOrElse(Vector(self))

  require(
    agents.map(_.name).distinct.size == agents.size,
    "every vehicle needs a name of its own"
  )
  for (agent, i) <- agents.zipWithIndex do
    require(
      opponents(i).nonEmpty,
      s"vehicle ${agent.name} has no opponent: a duel needs both roles"
    )

  val assignment: Assignment = Assignment(opponents)

  /** Index of the opponent of agent `self`: the nearest of its rivals, the first of equals.
    *
    * @param positionNed position of an agent by its index
    */
  def opponentOf(self: Int, positionNed: Int => Vector3): Int =
    assignment.opponentOf(self, other => positionNed(self).horizontalDistance(positionNed(other)))
