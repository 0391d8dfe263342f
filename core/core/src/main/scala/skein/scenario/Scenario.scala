package skein.scenario

import java.util.Locale
import skein.policy.{Agent, Fleet, Seen}
import skein.units.*

/** A task for a fleet: who flies, what may not happen, what is measured, and when it ends. A case class; its
  * fields are the task's settings, and their names end in units (`ringM`, `cruiseMps`). See
  * `docs/guides/own-scenario.md`.
  */
trait Scenario extends Product:

  /** Who flies: each vehicle's name, role, start and policy. */
  def agents: Vector[Agent]

  /** Limits of the task. Nothing enforces them; violations are counted, listed and shown. */
  def limits: Vector[Limit] = Vector.empty

  /** Quantities that the report draws over time. */
  def series: Vector[Series] = Vector.empty

  /** Numbers that a flight is summarised by. Flights are compared by the first. */
  def measures: Vector[Measure] = Vector.empty

  /** Of a flight, unless a command sets another. */
  def duration: Span = Span.ofSeconds(60)

  /** The built-in simulator's scene, unless a command sets another: `empty`, `forest`, `pursuit` or `street`.
    */
  def scene: String = "empty"

  /** Cameras and lidars of its vehicles. */
  def equipment: Vector[Equipment] = Vector.empty

  /** Estimates that policies have from cameras. */
  def eyes: Vector[Eye] = Vector.empty

  /** Whether the flight ends before its duration; asked at every decision. A pure function. */
  def isOver(known: Known): Boolean = false

  /** Whether it is the paper's game, beside whose flights the paper's figures stand, and whose policies are
    * searched and trained against each other.
    */
  def isPapersGame: Boolean = false

  /** Whether loops run as the paper's published code does, which confounds its result. */
  def isAsPublished: Boolean = false

  /** For the report: how to read the measures, in whole sentences. */
  def note: String = ""

  /** Every setting that cannot be flown: `name: expected …, came …`. */
  def mistakes: Seq[String] = Seq.empty

  /** One word, under which its settings stand in configurations and recordings. */
  def name: String = Scenario.worded(productPrefix)

  /** The name, with settings that tables have to show behind a comma. */
  def title: String = name

  /** Number of a vehicle's colour within its role, in figures. */
  def shade(vehicle: Int): Int = (0 until vehicle).count(agents(_).role == agents(vehicle).role)

  /** The same with at least so many vehicles, where there can be more: for rehearsals. */
  def crowded(vehicles: Int): Scenario = this

  /** Every setting by name, as [[ScenarioKind.read]] reads it. */
  final def settings: Vector[(String, String)] =
    productElementNames.zip(productIterator.map(_.toString)).toVector

  /** What a recording calls a setting. */
  def recordedAs(setting: String): String = s"$name.$setting"

  final def fleet: Fleet = Fleet(agents)

  /** Whether all steer in the plane, each at an altitude of its own. */
  final def isPlanar: Boolean = agents.forall(_.policy.isPlanar)

object Scenario:
  /** `OverTheRidge` as `over-the-ridge`. */
  private[scenario] def worded(name: String): String =
    name.replaceAll("(?<=.)([A-Z])", "-$1").toLowerCase(Locale.ROOT)

  /** What a scenario's code answers, its mistakes told by its name.
    *
    * @throws OwnFailure if it throws
    */
  private[skein] def told[A](name: => String)(answer: => A): A =
    OwnFailure.told(s"the scenario $name")(answer)

  /** Vehicles that no simulator can have, and no recording could hold. */
  private[scenario] def mistakeOfAgents(scenario: Scenario): Option[String] =
    val agents = scenario.agents
    val names  = agents.map(_.name)
    val same   =
      names.diff(names.distinct).headOption.map(name => s"a name of its own for each, came '$name' twice")
    same
      .orElse(agents.flatMap(agent => unflyable(agent).map(_ + s", of ${agent.name}")).headOption)
      .map("agents: expected " + _)

  private def unflyable(agent: Agent): Option[String] =
    val place = agent.startPositionNed
    val speed = agent.speed.value
    if !(speed >= 0 && speed.isFinite) then Some(s"a speed of 0 or more, came $speed m/s")
    else if !Seq(place.x, place.y, place.z).forall(_.isFinite) then
      Some(s"finite numbers as a start, came ${place.x}, ${place.y}, ${place.z}")
    else if !agent.startHeading.value.isFinite then
      Some(s"a finite number as the start's heading, came ${agent.startHeading.value}")
    else None

  /** The mistake of a number that is not in its bounds, if it is none. */
  def outside(name: String, value: Int, fewest: Int, most: Int): Option[String] =
    Option.when(value < fewest || value > most)(s"$name: expected $fewest to $most, came $value")

  /** The mistakes of a scenario's measures (`Double`) that are not above 0.
    *
    * @param mayBeZero names of those that may be 0
    */
  def notPositive(scenario: Scenario, mayBeZero: String*): Seq[String] =
    scenario.productElementNames
      .zip(scenario.productIterator)
      .collect:
        case (name, value: Double) if !(value > 0 || value == 0 && mayBeZero.contains(name)) =>
          s"$name: expected more than 0, came $value"
      .toSeq

/** What is known of a flight at a decision.
  *
  * @param elapsed since the flight's first decision
  * @param vehicles what is known of each, by its place
  */
final case class Known(elapsed: Span, vehicles: Vector[Seen])
