package skein.scenario

import java.util.Locale
import skein.policy.{Agent, Fleet, Seen}
import skein.units.*

/** A task for a fleet: its vehicles, limits, measures and end. A case class whose fields are the task's
  * settings; their names end in units (`ringM`, `cruiseMps`). See `docs/guides/own-scenario.md`.
  */
trait Scenario extends Product:

  /** The vehicles: each with its name, role, start and policy. */
  def agents: Vector[Agent]

  /** Limits of the task. They are not enforced; violations are counted, listed and shown. */
  def limits: Vector[Limit] = Vector.empty

  /** Quantities that the report draws over time. */
  def series: Vector[Series] = Vector.empty

  /** Values that summarise a flight. Flights are compared by the first. */
  def measures: Vector[Measure] = Vector.empty

  /** Duration of a flight, unless a command sets another. */
  def duration: Span = Span.ofSeconds(60)

  /** Scene of the built-in simulator, unless a command sets another: `empty`, `forest`, `pursuit` or
    * `street`.
    */
  def scene: String = "empty"

  def equipment: Vector[Equipment] = Vector.empty

  /** The estimates that policies derive from cameras. */
  def eyes: Vector[Eye] = Vector.empty

  /** Whether the flight ends now, before its duration; evaluated at every decision. A pure function. If it is
    * arithmetic, it is compiled to SIMD, as policies are (`docs/guides/formulas.md`).
    */
  def isOver(known: Known): Boolean = false

  /** Whether this is the paper's game. Its reports include the paper's figures, and its two policies are
    * searched and trained against each other.
    */
  def isPapersGame: Boolean = false

  /** Whether loops run as in the paper's published code, whose timing confounds its result. */
  def isAsPublished: Boolean = false

  /** Explanation of the measures for the report, in whole sentences. */
  def note: String = ""

  /** A message for each setting with an invalid value: `name: expected …, got …`. */
  def mistakes: Seq[String] = Seq.empty

  /** The scenario's identifier in configurations and recordings, one word. */
  def name: String = Scenario.worded(productPrefix)

  /** The name, followed by settings that tables must show, after a comma. */
  def title: String = name

  /** For a scenario that is data and not code, the recording's parameter for its text, and the text. */
  private[skein] def document: Option[(String, String)] = None

  /** Index of a vehicle's colour among those of its role, in figures. */
  def shade(vehicle: Int): Int = (0 until vehicle).count(agents(_).role == agents(vehicle).role)

  /** This scenario with at least this number of vehicles, if that is a setting; for rehearsals. */
  def crowded(vehicles: Int): Scenario = this

  /** Every setting with its value, as [[ScenarioKind.read]] reads it. */
  final def settings: Vector[(String, String)] =
    productElementNames.zip(productIterator.map(_.toString)).toVector

  def recordedAs(setting: String): String = s"$name.$setting"

  final def fleet: Fleet = Fleet(agents)

  /** Whether all vehicles steer horizontally, each at its own altitude. */
  final def isPlanar: Boolean = agents.forall(_.policy.isPlanar)

object Scenario:
  /** The name in words: `OverTheRidge` becomes `over-the-ridge`. */
  private[scenario] def worded(name: String): String =
    name.replaceAll("(?<=.)([A-Z])", "-$1").toLowerCase(Locale.ROOT)

  /** Evaluates a scenario's code; errors carry its name.
    *
    * @throws OwnFailure if it throws
    */
  private[skein] def told[A](name: => String)(answer: => A): A =
    OwnFailure.told(s"the scenario $name")(answer)

  /** A message for the first vehicle that no simulator or recording could represent, if any. */
  private[scenario] def mistakeOfAgents(scenario: Scenario): Option[String] =
    val agents = scenario.agents
    val names  = agents.map(_.name)
    val same   =
      names.diff(names.distinct).headOption.map(name => s"a name of its own for each, got '$name' twice")
    same
      .orElse(agents.flatMap(agent => unflyable(agent).map(_ + s", of ${agent.name}")).headOption)
      .map("agents: expected " + _)

  /** A speed above that of every vehicle model. */
  private val MostSpeedMps = 100.0

  private def unflyable(agent: Agent): Option[String] =
    val place   = agent.startPositionNed
    val speed   = agent.speed.value
    val heading = agent.startHeading.value
    if !(speed >= 0 && speed <= MostSpeedMps) then
      Some(s"a speed from 0 to $MostSpeedMps m/s, got $speed m/s")
    else if !Seq(place.x, place.y, place.z).forall(_.isFinite) then
      Some(s"finite numbers as a start, got ${place.x}, ${place.y}, ${place.z}")
    else if !(heading.abs <= 2 * math.Pi) then
      Some(s"a heading at the start in radians, from -2π to 2π, got $heading")
    else None

  /** A message if a value is outside its bounds. */
  def outside(name: String, value: Int, fewest: Int, most: Int): Option[String] =
    Expect.within(name, value, fewest, most).left.toOption

  /** A message for each `Double` setting of a scenario that is not above 0.
    *
    * @param mayBeZero names of settings that may be 0
    */
  def notPositive(scenario: Scenario, mayBeZero: String*): Seq[String] =
    scenario.productElementNames
      .zip(scenario.productIterator)
      .collect:
        case (name, value: Double) if !(value > 0 || value == 0 && mayBeZero.contains(name)) =>
          s"$name: expected more than 0, got $value"
      .toSeq

/** The state of a flight at a decision.
  *
  * @param elapsed time since the flight's first decision
  * @param vehicles the readings that the decision was made from, not predicted; by index
  */
final case class Known(elapsed: Span, vehicles: Vector[Seen])
