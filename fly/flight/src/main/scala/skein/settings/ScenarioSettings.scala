package skein.settings

import com.typesafe.config.{Config, ConfigObject, ConfigValue}
import scala.jdk.CollectionConverters.*
import skein.record.ParameterRow
import skein.scenario.{Scenario, ScenarioFile, ScenarioKind, ScenarioText, Scenarios}

/** A scenario in configurations and recordings. `skein.fly.scenario` names it, and its settings are under its
  * name: `skein.fly { scenario = crossing, crossing { vehicles = 8, lane-m = 6 } }`.
  */
object ScenarioSettings:

  /** Reads it from `skein.fly`. The default is the first known scenario.
    *
    * @return Left lists every mistake: where it is, what was expected, and what was given
    */
  def read(config: Config)(using Scenarios): Either[String, Scenario] =
    for
      kind <- kind(config)
      path = s"skein.fly.${kind.name}"
      set <- settingsAt(config, path)
      fields = kind.settings.map(name => ConfigKeys.ofField(name) -> name).toMap
      values = set.flatMap((key, value) => fields.get(key).map(_ -> value.unwrapped.toString))
      scenario <- kind.read(values).left.map(
        _.map(mistake => placed(ConfigKeys.ofMistake(mistake), path, set)).mkString("\n")
      )
    yield scenario

  /** A scenario with these settings, given by key.
    *
    * @return Left lists every mistake
    */
  def ofKeys(kind: ScenarioKind[?], settings: Map[String, String]): Either[String, Scenario] =
    byKeys(kind, settings)(kind.read)

  /** [[ofKeys]] by [[ScenarioKind.candidate]], without evaluating its definitions. */
  def candidate(kind: ScenarioKind[?], settings: Map[String, String]): Either[String, Scenario] =
    byKeys(kind, settings)(kind.candidate)

  private def byKeys(kind: ScenarioKind[?], settings: Map[String, String])(
      read: Map[String, String] => Either[Seq[String], Scenario]
  ): Either[String, Scenario] =
    val names = kind.settings.map(name => ConfigKeys.ofField(name) -> name).toMap
    read(settings.map((key, value) => names.getOrElse(key, key) -> value))
      .left
      .map(_.map(ConfigKeys.ofMistake).mkString("; "))

  def kind(config: Config)(using scenarios: Scenarios): Either[String, ScenarioKind[?]] =
    val named = Option.when(config.hasPath(Name))(config.getString(Name)).getOrElse(scenarios.names.head)
    scenarios.kind(named).left.map(mistake =>
      ConfigMistakes.oneLine(s"${ConfigMistakes.at(Name, config)}: $mistake")
    )

  def recorded(scenario: Scenario): Seq[ParameterRow] =
    scenario.settings.map((name, value) => ParameterRow(scenario.recordedAs(name), value)) ++
      scenario.document.map(ParameterRow(_, _))

  /** Resolves a word of `--scenario`: a scenario's name, or the path of a data file, recognised by its
    * ending. The file's text replaces the path from here on: in settings, questions to other processes, and
    * recordings.
    *
    * @return Left states where the file is wrong
    */
  def named(word: String): Either[String, String] =
    if ScenarioText.isText(word) || !word.endsWith(ScenarioFile.Suffix) then Right(word)
    else
      for
        text <- TextFile.read(word)
        _    <- ScenarioText.read(text).left.map(mistake => s"$word: $mistake")
      yield text

  private def Name = ConfigKeys.Scenario

  private def settingsAt(config: Config, path: String): Either[String, Map[String, ConfigValue]] =
    if !config.hasPath(path) then Right(Map.empty)
    else
      config.getValue(path) match
        case settings: ConfigObject => Right(settings.asScala.toMap)
        case other                  =>
          Left(
            s"${ConfigMistakes.at(path, other.origin)}: expected settings in braces, got ${ConfigMistakes.text(other)}"
          )

  /** Replaces the key at the beginning of a mistake by the source of its value. */
  private def placed(mistake: String, path: String, set: Map[String, ConfigValue]): String =
    val key  = mistake.takeWhile(_ != ':')
    val told = set.get(key).fold(s"$path.$mistake"): value =>
      ConfigMistakes.at(s"$path.$key", value.origin) + mistake.drop(key.length)
    ConfigMistakes.oneLine(told)
