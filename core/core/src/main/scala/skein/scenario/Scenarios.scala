package skein.scenario

import skein.forecast.Structure
import skein.policy.PolicyFamily

/** A user-defined control loop, with its name in settings and recordings. */
trait NamedLoop:
  def name: String

/** The kinds of scenarios, families of policies, structures of plants, and loops that a program knows by
  * name. It is required wherever settings or recordings are read.
  *
  * @param kinds the kinds of scenarios; the first is the default
  * @param families families of policies, in addition to Skein's
  * @param ownStructures structures of plants, in addition to Skein's
  * @param loops named loops, in addition to Skein's
  */
final case class Scenarios(
    kinds: Vector[ScenarioKind[?]],
    families: Vector[PolicyFamily] = Vector.empty,
    ownStructures: Vector[Structure] = Vector.empty,
    loops: Vector[NamedLoop] = Vector.empty
):
  require(kinds.nonEmpty, "at least one kind of scenario is needed")
  require(names.distinct.size == names.size, s"every kind needs a name of its own: ${names.mkString(", ")}")

  private val unspeakable = names.find(!_.matches("""[\p{L}\p{N}_-]+"""))
  require(
    unspeakable.isEmpty,
    s"expected letters, digits and dashes as a scenario's name, got '${unspeakable.mkString}'"
  )

  names.flatMap(ScenarioNames.mistake).foreach(why => throw IllegalArgumentException(why))
  PolicyFamily.mistake(families).foreach(why => throw IllegalArgumentException(why))

  val structures: Vector[Structure] = Structure.ours ++ ownStructures
  private val labels                = structures.map(_.label)
  require(
    labels.distinct.size == labels.size,
    s"every structure needs a label of its own: ${labels.mkString(", ")}"
  )

  require(
    loops.map(_.name).distinct.size == loops.size,
    s"every loop needs a name of its own: ${loops.map(_.name).mkString(", ")}"
  )

  def names: Vector[String] = kinds.map(_.name)

  /** The policy family with this name. Left lists the known names and the given one. */
  def family(name: String): Either[String, PolicyFamily] = PolicyFamily.parse(name, families)

  /** The structure with this label. Left lists the known labels and the given one. */
  def structure(label: String): Either[String, Structure] =
    structures
      .find(_.label == label)
      .toRight(s"expected a structure (${labels.mkString(", ")}), got '$label'")

  /** The default scenario of a program that does not include the paper's game; None in a program that does,
    * whose commands need the two sides of the game instead.
    */
  def firstWithoutGame: Option[String] = Option.when(!kinds.exists(_.standard.isPapersGame))(names.head)

  /** Whether a name with these settings means the unchanged paper's game, which every program knows. */
  def isPapersGame(name: String, set: Map[String, String]): Boolean =
    set.isEmpty && (kinds ++ Scenarios.ours.kinds).find(_.name == name).exists(_.standard.isPapersGame)

  /** The kind with this name, or that of a [[ScenarioFile]] with this text. Left lists the known names, the
    * given one, and the nearest.
    */
  def kind(name: String): Either[String, ScenarioKind[?]] =
    if ScenarioText.isText(name) then ScenarioText.read(name) else named(name)

  private def named(name: String) =
    kinds
      .find(_.name == name)
      .toRight(
        s"expected ${names.mkString(", ")}, got '$name'${
            if names.sizeIs > 1 then s"; the nearest is '${Nearest.to(name, names)}'" else ""
          }"
      )

  /** The scenario of a recording.
    *
    * @param name the recorded [[Scenario.name]]
    * @param parameters the recorded settings, keyed by name
    * @return Left says why this program does not know the scenario
    */
  def ofRecording(name: String, parameters: Map[String, String]): Either[String, Scenario] =
    kind(parameters.getOrElse(ScenarioFile.Recorded, name)).left
      .map("scenario: " + _)
      .flatMap(_.ofRecording(parameters).left.map(mistakes => s"scenario $name: ${mistakes.mkString("; ")}"))

object Scenarios:
  def apply(kinds: ScenarioKind[?]*): Scenarios = new Scenarios(kinds.toVector)

  val ours: Scenarios = Scenarios(
    ScenarioKind(PaperDuel()),
    ScenarioKind(Surround()),
    ScenarioKind(Formation()),
    ScenarioKind(Crossing()),
    ScenarioKind(Forest()),
    ScenarioKind(Convoy()),
    ScenarioKind(Shadow())
  )
