import skein.cli.SkeinApp
import skein.policy.*
import skein.scenario.*
import skein.units.*

/** Flies at full speed towards the place where the evader was last seen. */
case object Chase extends Policy:
  type Memory = Unit
  def start: Unit                                             = ()
  def choose(seen: Observation, memory: Unit): (Action, Unit) =
    val way = seen.vehicles(seen.opponent).kinematics.positionNed - seen.own.kinematics.positionNed
    (Action.Along(Radians(StrictMath.atan2(way.y, way.x)), seen.cruise, seen.startDown), ())

/** The paper's evader, chased. The field is a setting of every command: `--set chaser-mps=9`. */
final case class Hunt(chaserMps: Double = 10) extends Scenario:
  def agents: Vector[Agent] = Vector(
    PaperDuel().agents.head,
    Agent("Chaser", Role.Pursuer, MetresPerSecond(chaserMps), Vector3(0, 0, -20), Radians(0), Chase)
  )
  private val apart = Series.of("distance", "m", Separation)

  override def measures: Vector[Measure] =
    Vector(apart.mean("last 10 s", Window.Last(10)), apart.least("closest"))

/** All of Skein's commands for this scenario. */
object Main extends SkeinApp(ScenarioKind(Hunt()))
