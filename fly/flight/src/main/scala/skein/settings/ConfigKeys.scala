package skein.settings

import com.typesafe.config.{Config, ConfigOrigin, ConfigValueType}
import java.util.Locale
import pureconfig.error.KeyNotFound
import pureconfig.{ConfigReader, ReadsMissingKeys}
import scala.compiletime.{constValueTuple, summonAll}
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
  inline def reader[A](using mirror: Mirror.ProductOf[A]): ConfigReader[A] =
    ofFields(
      mirror,
      constValueTuple[mirror.MirroredElemLabels],
      summonAll[Tuple.Map[mirror.MirroredElemTypes, ConfigReader]]
    )

  def ofFields[A](mirror: Mirror.ProductOf[A], labels: Tuple, readers: Tuple): ConfigReader[A] =
    val keys = labels.productIterator.map(label => ofField(label.toString)).toVector
    val each = keys.zip(readers.productIterator.map(_.asInstanceOf[ConfigReader[Any]]))
    ConfigReader.fromCursor: cursor =>
      cursor.asObjectCursor.flatMap: found =>
        each
          .map: (key, reader) =>
            val value = found.atKeyOrUndefined(key)
            if value.isUndefined && !reader.isInstanceOf[ReadsMissingKeys] then
              found.failed(KeyNotFound.forKeys(key, found.keys))
            else reader.from(value)
          .foldLeft(Right(Vector.empty): ConfigReader.Result[Vector[Any]]):
            ConfigReader.Result.zipWith(_, _)(_ :+ _)
          .map(values => mirror.fromProduct(Tuple.fromArray(values.toArray)))
