package skein.airsim

import scala.collection.mutable
import scala.util.control.NonFatal
import skein.units.Vector3
import ujson.{Num, Obj, Value}

/** The reasons why a `settings.json` cannot be used; `path` states the key. */
enum SettingsError:
  case NotJson(reason: String)
  case Unexpected(path: String, expected: String, found: String)

  /** One line of bounded length, whatever the file's keys and values are. */
  def message: String = this match
    case NotJson(reason)                   => s"not JSON: ${SettingsError.shown(reason)}"
    case Unexpected(path, expected, found) =>
      s"${SettingsError.shown(path)}: expected $expected, found ${SettingsError.shown(found)}"

object SettingsError:
  /** A file's text for display within one line: its first 120 characters, without control characters. */
  def shown(text: String): String =
    val line = text.take(MostShown).map(letter => if letter.isControl then '\ufffd' else letter)
    if text.length > MostShown then s"$line…" else line

  private val MostShown = 120

/** An object of a `settings.json` and its path. A missing key reads as its default; the first invalid value
  * ends all reading. Keys that are read are remembered: [[unread]] lists all other keys, so that nothing in a
  * file is ignored silently.
  */
final private[skein] class SettingsSection private (fields: Obj, path: String, seen: SettingsSection.Read):
  import SettingsSection.*

  def has(key: String): Boolean = value(key).nonEmpty

  def fail(key: String, expected: String, found: String): Nothing =
    throw Misfit(SettingsError.Unexpected(at(key), expected, found))

  def number(key: String, unless: Double, least: Double = -1e9, most: Double = 1e9): Double =
    read(key, unless, "a number"):
      case Num(value) if value >= least && value <= most => value
      case number: Num => fail(key, s"a number from ${plain(least)} to ${plain(most)}", number.render())

  def whole(key: String, unless: Int, least: Int, most: Int): Int =
    val found = number(key, unless, least, most)
    if found.isWhole then found.toInt else fail(key, "a whole number", found.toString)

  def text(key: String, unless: String): String = read(key, unless, "a string"):
    case ujson.Str(value) => value

  def flag(key: String, unless: Boolean): Boolean = read(key, unless, "true or false"):
    case ujson.Bool(value) => value

  def section(key: String): SettingsSection =
    value(key).fold(SettingsSection(Obj(), at(key), seen))(of(key, _))

  /** The subsections by name, in the file's order. */
  def sections(key: String): Vector[(String, SettingsSection)] = section(key).parts

  private def parts = fields.value.keysIterator.toVector.map(name => name -> section(name))

  def list(key: String): Vector[SettingsSection] = read(key, Vector.empty, "an array"):
    case values: ujson.Arr => values.value.toVector.zipWithIndex.map((one, i) => of(s"$key[$i]", one))

  private def read[A](key: String, unless: A, expected: String)(found: PartialFunction[Value, A]): A =
    value(key).fold(unless)(found.applyOrElse(_, other => fail(key, expected, kindOf(other))))

  /** A vector with the keys X, Y and Z: NED, m or m/s. */
  def vector: Vector3 = Vector3(number("X", 0), number("Y", 0), number("Z", 0))

  /** Counts the whole section as read: a part that is switched off has no effect in AirSim either. */
  def switchedOff(): Unit = seen.all += path

  /** Marks every key of the section as unread, whatever was read before. */
  def passedOver(): Unit = seen.none += path

  /** The paths of all keys that were not read, in the file's order; a section of which nothing was read
    * counts as one path.
    */
  def unread: Vector[String] =
    if seen.all(path) then Vector.empty
    else if seen.none(path) then Vector(path)
    else
      fields.value.toVector.flatMap: (key, value) =>
        if !seen.keys(at(key)) then Vector(at(key))
        else
          value match
            case inner: Obj        => SettingsSection(inner, at(key), seen).unread
            case values: ujson.Arr =>
              values.value.toVector.zipWithIndex.collect { case (inner: Obj, i) =>
                SettingsSection(inner, at(s"$key[$i]"), seen).unread
              }.flatten
            case _ => Vector.empty

  private def value(key: String): Option[Value] =
    seen.keys += at(key)
    fields.value.get(key)

  private def at(key: String) = s"$path.$key".stripPrefix(".")

  private def of(key: String, value: Value): SettingsSection = value match
    case inner: Obj => SettingsSection(inner, at(key), seen)
    case other      => fail(key, "an object", kindOf(other))

private[skein] object SettingsSection:

  def read[A](text: String)(read: SettingsSection => A): Either[SettingsError, A] =
    try
      ujson.read(text) match
        case root: Obj => Right(read(SettingsSection(root, "", Read())))
        case other     => Left(SettingsError.Unexpected("the whole", "an object", kindOf(other)))
    catch
      case e: Misfit   => Left(e.error)
      case NonFatal(e) => Left(notJson(text, e))

  /** Paths: keys that were read, sections that count as read as a whole, and sections that count as unread.
    */
  final private class Read:
    val keys = mutable.Set.empty[String]
    val all  = mutable.Set.empty[String]
    val none = mutable.Set.empty[String]

  /** Formats a whole number without its `.0`. */
  private def plain(number: Double): String =
    if number.isWhole && number.abs < 1e15 then number.toLong.toString else number.toString

  final private class Misfit(val error: SettingsError)
      extends RuntimeException(error.message, null, false, false)

  /** The position at which a text stops being valid JSON, and the mistake there.
    *
    * @param mistake the exception of `ujson`, whose cause states the mistake after the whole path to it
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
