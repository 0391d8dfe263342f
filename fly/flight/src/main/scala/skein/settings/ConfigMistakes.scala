package skein.settings

import com.typesafe.config.*
import pureconfig.error.*
import scala.jdk.CollectionConverters.*
import skein.scenario.{Nearest, ScenarioText, Scenarios}

/** Describes mistakes in a configuration, a line for each value: `FILE: LINE: PATH: expected …, got …`. A
  * value from an option is identified by the option's name.
  */
private[skein] object ConfigMistakes:

  /** Structural mistakes below `path`, whatever the values: keys that `reference.conf` does not know, nulls,
    * and a section, list or single value where another of these is expected.
    *
    * @return None if there is none
    */
  def ofShape(config: Config, path: String)(using Scenarios): Option[String] =
    ofValue(config.getValue(path), known(config).getValue(path), path).reduceOption(_ + "\n" + _)

  /** Keys of a file that lie outside `path`: none of them is read. */
  def besideInFile(file: Config, path: String): Option[String] =
    path
      .split('.')
      .toSeq
      .inits
      .toSeq
      .reverse
      .tail
      .flatMap: chain =>
        val parent = chain.init
        val at     = if parent.isEmpty then Some(file.root) else objectAt(file, parent.mkString("."))
        at.toSeq.flatMap(keys).collect:
          case (key, value) if key != chain.last => unknown(value, (parent :+ key).mkString("."), Seq(path))
      .reduceOption(_ + "\n" + _)

  /** The values that pureconfig could not read: options first, then a file's lines in order. */
  def of(failures: ConfigReaderFailures, config: Config): String = failures.toList
    .sortBy(_.origin.fold(-1)(_.lineNumber))
    .map:
      case ConvertFailure(reason, origin, path) =>
        oneLine(origin.fold(path)(at(path, _)) + ": " + because(reason, path, config))
      case other => other.origin.fold("")(_.description + ": ") + oneLine(other.description)
    .distinct
    .mkString("\n")

  /** The source of a value: its option, or file, line and path. Defaults have only a path. */
  def at(path: String, origin: ConfigOrigin): String =
    ConfigKeys.optionOf(origin).getOrElse:
      if origin.description.startsWith(Ours) then path else s"${origin.description}: $path"

  /** The source of the value at a path, or only the path if there is no value. */
  def at(path: String, config: Config): String =
    if config.hasPath(path) then at(path, config.getValue(path).origin) else path

  /** Whether a value at a path is set by an option, a file or the environment: it is no default. */
  def isGiven(path: String, config: Config): Boolean =
    config.hasPath(path) && !config.getValue(path).origin.description.startsWith(Ours)

  /** Joins the lines of a message, such as a library's exception message, into one line. */
  def oneLine(text: String): String = text.linesIterator.map(_.trim).filter(_.nonEmpty).mkString(" ")

  /** Reads a configuration; converts an exception of the library to one line. */
  def guarded[A](path: String)(read: => Either[String, A]): Either[String, A] =
    try read
    catch
      case mistake: ConfigException => Left(oneLine(mistake.getMessage))
      case _: StackOverflowError    => Left(s"$path: it is nested too deeply to be read")

  private val Ours = "reference.conf"

  private def because(reason: FailureReason, path: String, config: Config): String = reason match
    case CannotConvert(value, "Boolean", _) => s"expected true or false, got '$value'"
    case CannotConvert(_, _, because)       => oneLine(because)
    case WrongType(_, expected)             =>
      val came = if config.hasPath(path) then text(config.getValue(path)) else "nothing"
      s"expected ${expected.map(named).toSeq.sorted.mkString(" or ")}, got $came"
    case EmptyStringFound(_) => "expected a value, got ''"
    case KeyNotFound(key, _) => s"expected '$key', got nothing"
    case other               => oneLine(other.description)

  private def named(kind: ConfigValueType): String = kind match
    case ConfigValueType.NUMBER  => "a number"
    case ConfigValueType.BOOLEAN => "true or false"
    case ConfigValueType.STRING  => "a text"
    case ConfigValueType.LIST    => "a list in brackets"
    case ConfigValueType.OBJECT  => "settings in braces"
    case ConfigValueType.NULL    => "null"

  /** A value as the user wrote it. */
  def text(value: ConfigValue): String = value.valueType match
    case ConfigValueType.OBJECT => "settings in braces"
    case ConfigValueType.LIST   => "a list"
    case ConfigValueType.NULL   => "null"
    case _                      => s"'${value.unwrapped}'"

  private def ofValue(value: ConfigValue, known: ConfigValue, path: String): Seq[String] =
    def expected(what: String) =
      Seq(oneLine(s"${at(path, value.origin)}: expected $what, got ${text(value)}"))
    (known, value) match
      case (known: ConfigObject, set: ConfigObject) =>
        keys(set).flatMap: (key, value) =>
          val below = s"$path.$key"
          Option(known.get(key)).fold(
            Seq(unknown(value, below, known.keySet.asScala.toSeq))
          )(ofValue(value, _, below))
      case (_: ConfigObject, _)                 => expected("settings in braces")
      case (_: ConfigList, several: ConfigList) =>
        several.asScala.toSeq.filterNot(isSingle).map: one =>
          s"${at(path, one.origin)}: expected a list of single values, got ${text(one)} in it"
      case (_: ConfigList, _)                                         => expected("a list in brackets")
      case _ if value.valueType == known.valueType || isSingle(value) => Nil
      case _ if value.valueType == ConfigValueType.NULL               => expected("a value")
      case _                                                          => expected("a single value")

  private def isSingle(value: ConfigValue): Boolean = value.valueType match
    case ConfigValueType.NUMBER | ConfigValueType.BOOLEAN | ConfigValueType.STRING => true
    case _                                                                         => false

  private def keys(of: ConfigObject): Seq[(String, ConfigValue)] = of.asScala.toSeq.sortBy(_._1)

  private def objectAt(file: Config, path: String): Option[ConfigObject] =
    Option.when(file.hasPath(path))(file.getValue(path)).collect { case found: ConfigObject => found }

  private def unknown(value: ConfigValue, path: String, known: Seq[String]): String =
    val key = path.split('.').lastOption.getOrElse(path)
    renamed.get(path) match
      case Some(now) => s"${value.origin.description}: no setting '$path' any more; it is '$now' now"
      case None      =>
        s"${value.origin.description}: no setting '$path'; the nearest is '${Nearest.to(key.take(MostLetters), known)}'"

  /** Maximum length of a key that is compared with known keys. */
  private val MostLetters = 100

  private val renamed = Map(
    "skein.fly.model"        -> "predictor",
    "skein.fly.pairs"        -> "duel.pairs",
    "skein.fly.as-published" -> "duel.as-published",
    "skein.fly.altitude-m"   -> "duel.altitude-m"
  )

  private lazy val ours = ConfigFactory.parseResources(getClass.getClassLoader, Ours).resolve()

  /** The known keys, with the scenarios' settings under their names. */
  private def known(config: Config)(using scenarios: Scenarios): Config =
    val chosen = Option.when(ConfigKeys.hasText(config, ConfigKeys.Scenario)):
      config.getString(ConfigKeys.Scenario)
    val ofFile = chosen.filter(ScenarioText.isText).flatMap(scenarios.kind(_).toOption)
    (scenarios.kinds ++ ofFile).foldLeft(ours): (known, kind) =>
      kind.standard.settings.foldLeft(known):
        case (known, (name, value)) =>
          known.withValue(
            s"skein.fly.${kind.name}.${ConfigKeys.ofField(name)}",
            ConfigValueFactory.fromAnyRef(value)
          )
