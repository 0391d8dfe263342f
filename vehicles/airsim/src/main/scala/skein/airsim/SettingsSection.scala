package skein.airsim

import scala.util.control.NonFatal
import skein.units.Vector3
import ujson.{Num, Obj, Value}

/** Why a `settings.json` cannot be used: `path` names the key. */
enum SettingsError:
  case NotJson(reason: String)
  case Unexpected(path: String, expected: String, found: String)

  def message: String = this match
    case NotJson(reason)                   => s"not JSON: $reason"
    case Unexpected(path, expected, found) => s"$path: expected $expected, found $found"

/** An object of a `settings.json`, and where it stands. What it lacks is read as said; at the first value
  * that does not fit, all reading ends.
  */
final private[skein] class SettingsSection private (fields: Obj, path: String):
  import SettingsSection.*

  def has(key: String): Boolean = fields.value.contains(key)

  def fail(key: String, expected: String, found: String): Nothing =
    throw Misfit(SettingsError.Unexpected(at(key), expected, found))

  def number(key: String, unless: Double, least: Double = -1e9, most: Double = 1e9): Double =
    fields.value.get(key) match
      case Some(Num(value)) if value >= least && value <= most => value
      case Some(number: Num) => fail(key, s"a number from $least to $most", number.render())
      case Some(other)       => fail(key, "a number", kindOf(other))
      case None              => unless

  def text(key: String, unless: String): String = fields.value.get(key) match
    case Some(ujson.Str(value)) => value
    case Some(other)            => fail(key, "a string", kindOf(other))
    case None                   => unless

  def flag(key: String, unless: Boolean): Boolean = fields.value.get(key) match
    case Some(ujson.Bool(value)) => value
    case Some(other)             => fail(key, "true or false", kindOf(other))
    case None                    => unless

  def section(key: String): SettingsSection =
    fields.value.get(key).fold(SettingsSection(Obj(), at(key)))(of(key, _))

  /** By their names, in the file's order. */
  def sections(key: String): Vector[(String, SettingsSection)] = section(key).parts

  private def parts = fields.value.toVector.map((name, value) => name -> of(name, value))

  def list(key: String): Vector[SettingsSection] = fields.value.get(key) match
    case Some(values: ujson.Arr) => values.value.toVector.map(of(key, _))
    case Some(other)             => fail(key, "an array", kindOf(other))
    case None                    => Vector.empty

  /** NED, m or m/s. */
  def vector: Vector3 = Vector3(number("X", 0), number("Y", 0), number("Z", 0))

  private def at(key: String) = s"$path.$key".stripPrefix(".")

  private def of(key: String, value: Value): SettingsSection = value match
    case inner: Obj => SettingsSection(inner, at(key))
    case other      => fail(key, "an object", kindOf(other))

private[skein] object SettingsSection:

  /** Reads a file's text. */
  def read[A](text: String)(read: SettingsSection => A): Either[SettingsError, A] =
    try
      ujson.read(text) match
        case root: Obj => Right(read(SettingsSection(root, "")))
        case other     => Left(SettingsError.Unexpected("the whole", "an object", kindOf(other)))
    catch
      case e: Misfit   => Left(e.error)
      case NonFatal(e) => Left(notJson(text, e))

  final private class Misfit(val error: SettingsError)
      extends RuntimeException(error.message, null, false, false)

  /** Where a text stopped to be JSON, and what is wrong there.
    *
    * @param mistake of `ujson`, which names the mistake in its cause, and before it the whole path to it
    */
  private def notJson(text: String, mistake: Throwable): SettingsError =
    Iterator.iterate(mistake)(_.getCause).takeWhile(_ != null).take(MostCauses).collectFirst {
      case wrong: ujson.ParseException =>
        val line = text.take(wrong.index).count(_ == '\n') + 1
        s"${wrong.clue}, in line $line"
      case _: ujson.IncompleteParseException => "it ends too early"
    } match
      case Some(reason) => SettingsError.NotJson(reason)
      case None         => SettingsError.NotJson(s"${mistake.getMessage}".take(MostOfReason))

  private val MostCauses   = 16
  private val MostOfReason = 200

  private def kindOf(value: Value): String = value match
    case _: Obj        => "an object"
    case _: ujson.Arr  => "an array"
    case _: ujson.Str  => "a string"
    case _: Num        => "a number"
    case _: ujson.Bool => "a boolean"
    case ujson.Null    => "null"
