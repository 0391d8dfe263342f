package skein.scenario

import skein.forecast.Structure
import skein.policy.PolicyFamily

/** A control loop of a program's own, by its name in settings and recordings. */
trait NamedLoop:
  def name: String

/** The kinds of scenarios, the families of policies, the structures of plants, and the loops, that a program
  * knows by name; needed wherever settings or recordings are read.
  *
  * @param kinds the first is flown where none is named
  * @param families of policies, besides Skein's
  * @param ownStructures of plants, besides Skein's
  * @param loops besides Skein's
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
    s"expected letters, digits and dashes as a scenario's name, came '${unspeakable.mkString}'"
  )

  PolicyFamily.mistake(families).foreach(why => throw IllegalArgumentException(why))

  /** Skein's first. */
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

  /** @return or what was expected and came */
  def family(name: String): Either[String, PolicyFamily] = PolicyFamily.parse(name, families)

  /** @return or what was expected and came */
  def structure(label: String): Either[String, Structure] =
    structures
      .find(_.label == label)
      .toRight(s"expected a structure (${labels.mkString(", ")}), came '$label'")

  /** The default scenario of a program without the paper's game, of whose two sides commands ask otherwise.
    */
  def firstWithoutGame: Option[String] = Option.when(!kinds.exists(_.standard.isPapersGame))(names.head)

  /** Whether a name, with these settings, is that of the paper's game as it is; ours is known to every
    * program.
    */
  def isPapersGame(name: String, set: Map[String, String]): Boolean =
    set.isEmpty && (kinds ++ Scenarios.ours.kinds).find(_.name == name).exists(_.standard.isPapersGame)

  /** @return or what was expected, what came, and what is nearest */
  def kind(name: String): Either[String, ScenarioKind[?]] =
    kinds
      .find(_.name == name)
      .toRight(
        s"expected ${names.mkString(", ")}, came '$name'${
            if names.sizeIs > 1 then s"; the nearest is '${Nearest.to(name, names)}'" else ""
          }"
      )

  /** The scenario that a recording is of.
    *
    * @param name [[Scenario.name]]
    * @param parameters of the recording, by name
    * @return or why it is not known here
    */
  def ofRecording(name: String, parameters: Map[String, String]): Either[String, Scenario] =
    kind(name).left
      .map("scenario: " + _)
      .flatMap(_.ofRecording(parameters).left.map(mistakes => s"scenario $name: ${mistakes.mkString("; ")}"))

object Scenarios:
  def apply(kinds: ScenarioKind[?]*): Scenarios = new Scenarios(kinds.toVector)

  /** Skein's own. */
  val ours: Scenarios = Scenarios(
    ScenarioKind(PaperDuel()),
    ScenarioKind(Surround()),
    ScenarioKind(Formation()),
    ScenarioKind(Crossing()),
    ScenarioKind(Forest()),
    ScenarioKind(Convoy())
  )
