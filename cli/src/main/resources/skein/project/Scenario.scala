package @PACKAGE@

import skein.cli.SkeinApp
import skein.policy.*
import skein.scenario.*
import skein.units.*

/** All of Skein's commands for this scenario: `./skein fly`, `./skein spread`, `./skein report` … */
object Main extends SkeinApp(ScenarioKind(@CLASS@()))

/** A leader flies a square whose corners rise and sink; a wing keeps behind it. Its fields are its settings:
  * `./skein fly --set side-m=60`.
  */
final case class @CLASS@(sideM: Double = 40, behindM: Double = 6, leaderMps: Double = 4) extends Scenario:
  private val corners =
    Vector(Vector3(sideM, 0, -10), Vector3(sideM, sideM, -20), Vector3(0, sideM, -10), Vector3(0, 0, -20))

  def agents: Vector[Agent] =
    val (leader, wing) = (MetresPerSecond(leaderMps), MetresPerSecond(2 * leaderMps))
    Vector(
      Agent("Leader", Role.Leader, leader, Vector3(0, 0, -10), Radians(0), Corners(corners)),
      Agent("Wing", Role.Follower, wing, Vector3(-behindM, 0, -10), Radians(0), Behind(0, behindM))
    )

  override def limits: Vector[Limit] =
    Vector(Limit.separation(Metres(2)), Limit.floor(Metres(3)), Limit.ceiling(Metres(25)))

  private val apart = Series("distance", "m", Some(Bound("asked for", behindM)))(tracks => tracks.separationM(0, 1, _))

  override def series: Vector[Series]    = Vector(apart)
  override def measures: Vector[Measure] =
    val settled = Window.After(10)
    Vector(apart.mean("distance", settled), apart.least("closest"), apart.most("furthest", settled))

  override def note: String = "Distance from the leader to the wing after the first 10 s."

/** Flies from corner to corner; remembers which is the next. */
final case class Corners(places: Vector[Vector3]) extends AgentPolicy:
  type Memory = Int
  def start: Int                                            = 0
  def choose(seen: Observation, memory: Int): (Action, Int) =
    val here = seen.own.kinematics.positionNed
    val next = if (places(memory) - here).norm < 2 then (memory + 1) % places.size else memory
    (Action.Position(places(next), seen.cruise, Yaw.Forward), next)

/** Keeps at a distance behind another vehicle, along the line between the two. */
final case class Behind(leader: Int, metres: Double) extends AgentPolicy:
  type Memory = Unit
  def start: Unit                                             = ()
  def choose(seen: Observation, memory: Unit): (Action, Unit) =
    val leads = seen.vehicles(leader).kinematics
    val way   = leads.positionNed - seen.own.kinematics.positionNed
    val speed = leads.velocityNed + way * ((way.norm - metres) / way.norm.max(1e-9))
    (Action.Velocity(speed * (seen.cruise.value / speed.norm.max(seen.cruise.value))), ())
