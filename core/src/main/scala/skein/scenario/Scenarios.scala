package skein.scenario

/** The kinds of scenarios that a program knows, by name; needed wherever settings or recordings are read.
  *
  * @param kinds
  *   the first is flown where none is named
  */
final case class Scenarios(kinds: Vector[ScenarioKind[?]]):
  require(kinds.nonEmpty, "at least one kind of scenario is needed")
  require(names.distinct.size == names.size, s"every kind needs a name of its own: ${names.mkString(", ")}")

  def names: Vector[String] = kinds.map(_.name)

  /** The default scenario of a program without the duel. */
  def firstWithoutDuel: Option[String] = Option.when(!names.contains(PaperDuel.Name))(names.head)

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
    * @param title
    *   [[Scenario.title]], and what else stands behind a comma
    * @param parameters
    *   of the recording, by name
    * @return
    *   or why it is not known here
    */
  def ofRecording(title: String, parameters: Map[String, String]): Either[String, Scenario] =
    val name = title.takeWhile(_ != ',')
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
    ScenarioKind(Forest())
  )
