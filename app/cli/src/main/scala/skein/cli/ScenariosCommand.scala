package skein.cli

import mainargs.{Flag, ParserForClass, arg}
import skein.report.{Section, TextTable}
import skein.scenario.{Scenario, Scenarios}
import skein.settings.ConfigKeys

/** Command-line options of `./skein scenarios`, with their help texts. */
final case class ScenariosOptions(@arg(doc = Shown.Doc) json: Flag)

/** `./skein scenarios`: lists the program's scenarios with their settings. */
final class ScenariosCommand(using scenarios: Scenarios)
    extends OptionsCommand[ScenariosOptions](
      "scenarios",
      "lists the scenarios that can be flown, with their settings",
      ParserForClass[ScenariosOptions]
    ):

  protected def execute(options: ScenariosOptions): Either[String, Unit] =
    val sections = scenarios.kinds.map: kind =>
      val standard = kind.standard
      Scenario.told(kind.name):
        Section(
          s"${standard.name}: ${standard.agents.size} vehicles, ${standard.duration.toSeconds.round} s",
          (standard.limits.map(limit => s"Limit: ${limit.text}.") :+ standard.note).mkString(" ").trim,
          Some(TextTable(
            Vector("<setting", "default"),
            standard.settings.map((name, value) => Vector(ConfigKeys.ofField(name), value))
          ))
        )
    Shown(options.json.value).tables(sections, Section.text(sections))
    Right(())
