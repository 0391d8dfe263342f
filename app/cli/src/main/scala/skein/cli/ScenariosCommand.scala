package skein.cli

import mainargs.{Flag, Leftover, ParserForClass, arg}
import skein.report.{Section, TextTable}
import skein.scenario.{FileScenario, Scenario, ScenarioKind, Scenarios}
import skein.settings.{ConfigKeys, ScenarioSettings}
import skein.units.Expect

/** Command-line options of `./skein scenarios`, with their help texts. */
final case class ScenariosOptions(
    @arg(doc = "files of scenarios, for example patrol.scenario; without them, the program's own are listed")
    files: Leftover[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

/** `./skein scenarios`: lists the program's scenarios, or those of files, with their settings. */
final class ScenariosCommand(using scenarios: Scenarios)
    extends Command[ScenariosOptions](
      "scenarios",
      "lists the scenarios that can be flown, with their settings",
      ParserForClass[ScenariosOptions]
    ):

  protected def execute(options: ScenariosOptions): Either[String, Unit] =
    val files = options.files.value
    for kinds <- if files.isEmpty then Right(scenarios.kinds) else Expect.each(files)(ofFile)
    yield
      val sections = kinds.map(listed)
      Shown(options.json.value).tables(sections, Section.text(sections))

  private def ofFile(word: String): Either[String, ScenarioKind[?]] =
    ScenarioSettings.named(word).flatMap(scenarios.kind)

  private def listed(kind: ScenarioKind[?]): Section =
    val standard = kind.standard
    val meanings = standard match
      case data: FileScenario => data.file.settings.map(_.meaning)
      case _                  => Vector.empty
    Scenario.told(kind.name):
      Section(
        s"${standard.name}: ${standard.agents.size} vehicles, ${standard.duration.toSeconds.round} s",
        (standard.limits.map(limit => s"Limit: ${limit.text}.") :+ standard.note).mkString(" ").trim,
        Some(TextTable(
          Vector("<setting", "default") ++ meanings.headOption.map(_ => "<meaning"),
          standard.settings.zipWithIndex.map:
            case ((name, value), place) => Vector(ConfigKeys.ofField(name), value) ++ meanings.lift(place)
        ))
      )
