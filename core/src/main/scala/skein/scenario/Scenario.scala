package skein.scenario

import java.util.Locale
import skein.policy.{Agent, Fleet, PlanarPolicy, Seen}
import skein.units.*

/** A task for a fleet: who flies, what may not happen, what is measured, and when it ends. A case class; its fields are
  * the task's settings, and their names end in units (`ringM`, `cruiseMps`). See `docs/guides/own-scenario.md`.
  */
trait Scenario extends Product:

  /** Who flies: where each vehicle starts, what it is to the others, and the policy that it flies by. */
  def agents: Vector[Agent]

  /** What may not happen. Nothing prevents it; what did happen is counted, listed and shown. */
  def limits: Vector[Limit] = Vector.empty

  /** What is drawn over time. */
  def series: Vector[Series] = Vector.empty

  /** What a flight comes to. The first stands for the flight when it is compared with others. */
  def measures: Vector[Measure] = Vector.empty

  /** How long it flies, unless it is told otherwise. */
  def duration: Span = Span.ofSeconds(60)

  /** What stands in the world that it is flown in, unless a flight is told otherwise: a scene that ships. */
  def scene: String = "empty"

  /** What its vehicles carry to see by. */
  def equipment: Vector[Equipment] = Vector.empty

  /** What their policies know by cameras. */
  def eyes: Vector[Eye] = Vector.empty

  /** Whether it is over before its time; asked upon every decision. A pure function. */
  def isOver(known: Known): Boolean = false

  /** What its measures mean, for the report: whole sentences. */
  def note: String = ""

  /** Every setting that cannot be flown: `name: expected …, came …`. */
  def mistakes: Seq[String] = Seq.empty

  /** One word, under which its settings stand in configurations and recordings. */
  def name: String = Scenario.worded(productPrefix)

  /** The same, with what has to be told of the settings. */
  def title: String = name

  /** By which pictures tell the vehicles of one role apart: equal numbers, equal colours. */
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
  final def isPlanar: Boolean = agents.forall(_.policy.isInstanceOf[PlanarPolicy])

object Scenario:
  /** `OverTheRidge` as `over-the-ridge`. */
  private[scenario] def worded(name: String): String =
    name.replaceAll("(?<=.)([A-Z])", "-$1").toLowerCase(Locale.ROOT)

  /** The mistake of a number that is not in its bounds, if it is none. */
  def outside(name: String, value: Int, fewest: Int, most: Int): Option[String] =
    Option.when(value < fewest || value > most)(s"$name: expected $fewest to $most, came $value")

  /** The mistakes of a scenario's measures (`Double`) that are not above 0.
    *
    * @param mayBeZero
    *   names of those that may be 0
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
  * @param elapsed
  *   since the flight's first decision
  * @param vehicles
  *   what is known of each, by its place
  */
final case class Known(elapsed: Span, vehicles: Vector[Seen])
