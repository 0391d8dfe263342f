package patience

import skein.cli.SkeinApp
import skein.policy.*
import skein.scenario.*
import skein.units.*

/** Follows its opponent at a distance, and trusts a reading less the older it is: it matches the opponent's
  * velocity in proportion to the reading's freshness. Remembers the readings' ages.
  *
  * @param trustS age at which a reading's velocity counts half
  */
final case class Patient(metres: Double, trustS: Double) extends Policy:
  type Memory = Double
  def start: Double = 0

  def choose(seen: Observation, meanAgeS: Double): (Action, Double) =
    val other = seen.vehicles(seen.opponent)
    // A reading that the loop has predicted to the command's time counts as fresh.
    val old   = if other.isPredicted then 0.0 else other.age.toSeconds
    val age   = meanAgeS + (old - meanAgeS) * 0.1
    val trust = trustS / (trustS + age)
    val way   = other.kinematics.positionNed - seen.own.kinematics.positionNed
    val wish  = other.kinematics.velocityNed * trust + way * (0.5 * (way.norm - metres) / way.norm.max(1e-9))
    (Action.Velocity(wish * (seen.cruise.value / wish.norm.max(seen.cruise.value)), Yaw.Forward), age)

/** The paper's evader, followed by the patient pursuer. */
final case class Chase(metres: Double = 8, trustS: Double = 0.2) extends Scenario:
  def agents: Vector[Agent] =
    val evader = PaperDuel().agents.head
    val behind = Vector3(0, 0, evader.startPositionNed.z)
    Vector(
      evader,
      Agent("Patient", Role.Pursuer, MetresPerSecond(10), behind, Radians(0), Patient(metres, trustS))
    )

  private val apart =
    Series("distance", "m", Some(Bound("asked for", metres)))(tracks => tracks.separationM(0, 1, _))

  override def series: Vector[Series]    = Vector(apart)
  override def measures: Vector[Measure] =
    val last = Window.Last(10)
    Vector(apart.mean("last 10 s", last), apart.sd("sd", last), apart.least("closest"))

/** All of Skein's commands for this scenario. */
object Main extends SkeinApp(ScenarioKind(Chase()))
