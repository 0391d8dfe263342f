package skein.settings

import com.typesafe.config.{Config, ConfigOrigin, ConfigValueType}
import java.util.Locale
import pureconfig.generic.derivation.{
  ConfigReaderDerivation,
  CoproductConfigReaderDerivation,
  ProductConfigReaderDerivation
}
import pureconfig.{ConfigFieldMapping, ConfigReader}
import scala.annotation.nowarn
import scala.deriving.Mirror

/** Maps field names to keys of the configuration: `moves-in-flight` for the field `movesInFlight`, in every
  * locale (pureconfig's own mapping turns I into a dotless ı on a Turkish machine).
  */
private[skein] object ConfigKeys:

  /** The path of the scenario in a configuration. */
  val Scenario = "skein.fly.scenario"

  def hasText(config: Config, path: String): Boolean =
    config.hasPath(path) && config.getValue(path).valueType == ConfigValueType.STRING

  def ofField(name: String): String = name.replaceAll("([A-Z])", "-$1").toLowerCase(Locale.ROOT)

  /** Replaces the field's name at the beginning of a mistake by its key. */
  def ofMistake(mistake: String): String =
    val (name, rest) = mistake.splitAt(mistake.indexOf(':'))
    ofField(name) + rest

  /** The option from which a value comes, if any. */
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
