package skein.settings

import com.typesafe.config.{
  Config,
  ConfigFactory,
  ConfigObject,
  ConfigOrigin,
  ConfigValue,
  ConfigValueFactory
}
import java.util.Locale
import pureconfig.generic.derivation.{
  ConfigReaderDerivation,
  CoproductConfigReaderDerivation,
  ProductConfigReaderDerivation
}
import pureconfig.{ConfigFieldMapping, ConfigReader}
import scala.annotation.nowarn
import scala.deriving.Mirror
import scala.jdk.CollectionConverters.*
import skein.scenario.{Nearest, Scenarios}

/** The keys of the configuration: `moves-in-flight` for the field `movesInFlight`, in every locale
  * (pureconfig's own mapping turns I into a dotless ı where the machine is Turkish); and those that mean
  * nothing.
  */
private[skein] object ConfigKeys:

  /** The key of a field. */
  def ofField(name: String): String = name.replaceAll("([A-Z])", "-$1").toLowerCase(Locale.ROOT)

  /** A mistake that begins with a field's name, by its key. */
  def ofMistake(mistake: String): String =
    val (name, rest) = mistake.splitAt(mistake.indexOf(':'))
    ofField(name) + rest

  /** The option that a value came from, if one did. */
  def optionOf(origin: ConfigOrigin): Option[String] =
    Some(origin.description).filter(_.startsWith("--"))

  /** Reads a case class from an object with a key for each field. */
  inline def reader[A](using inline mirror: Mirror.Of[A]): ConfigReader[A] =
    ByField.derived(ConfigReader)[A]

  // pureconfig moves this to another artifact, which we need for nothing else.
  @nowarn("cat=deprecation")
  object ByField
      extends ConfigReaderDerivation
      with CoproductConfigReaderDerivation(ConfigFieldMapping(ofField), "type")
      with ProductConfigReaderDerivation(ConfigFieldMapping(ofField))

  /** Every key below `path` that `reference.conf` does not know, a line each: where it stands, and the
    * nearest that is known.
    *
    * @return None if all are known
    */
  def unknown(config: Config, path: String)(using Scenarios): Option[String] =
    lines(config.getConfig(path).root, known.getConfig(path).root, path)

  /** The same for a whole file, of which nothing but `path` is read. */
  def unknownInFile(file: Config, path: String)(using Scenarios): Option[String] =
    val above  = path.split('.').toSeq
    val chains = above.inits.toSeq.reverse.tail
    chains
      .flatMap: chain =>
        val parent = chain.init
        val at     = if parent.isEmpty then Some(file.root) else objectAt(file, parent.mkString("."))
        at.toSeq.flatMap(_.asScala.collect:
          case (key, value) if key != chain.last => line(value, (parent :+ key).mkString("."), Seq(path)))
      .reduceOption(_ + "\n" + _)
      .orElse(objectAt(file, path).flatMap(lines(_, known.getConfig(path).root, path)))

  private def objectAt(file: Config, path: String): Option[ConfigObject] =
    Option.when(file.hasPath(path))(file.getValue(path)).collect { case found: ConfigObject => found }

  private def lines(given_ : ConfigObject, known: ConfigObject, path: String): Option[String] =
    given_.asScala.toSeq
      .sortBy(_._1)
      .flatMap: (key, value) =>
        (known.get(key), value) match
          case (null, _) => Some(line(value, s"$path.$key", known.keySet.asScala.toSeq))
          case (known: ConfigObject, v: ConfigObject) => lines(v, known, s"$path.$key")
          case _                                      => None
      .reduceOption(_ + "\n" + _)

  private def line(value: ConfigValue, path: String, known: Seq[String]): String =
    val key = path.split('.').last
    renamed.get(path) match
      case Some(now) => s"${value.origin.description}: no setting '$path' any more; it is '$now' now"
      case None      =>
        s"${value.origin.description}: no setting '$path'; the nearest is '${Nearest.to(key, known)}'"

  private val renamed = Map(
    "skein.fly.model"        -> "predictor",
    "skein.fly.pairs"        -> "duel.pairs",
    "skein.fly.as-published" -> "duel.as-published",
    "skein.fly.altitude-m"   -> "duel.altitude-m"
  )

  private lazy val ours = ConfigFactory.parseResources(getClass.getClassLoader, "reference.conf").resolve()

  /** Scenarios' settings stand under their names. */
  private def known(using scenarios: Scenarios): Config =
    scenarios.kinds.foldLeft(ours): (known, kind) =>
      kind.standard.settings.foldLeft(known):
        case (known, (name, value)) =>
          known.withValue(s"skein.fly.${kind.name}.${ofField(name)}", ConfigValueFactory.fromAnyRef(value))
