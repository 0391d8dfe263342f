package skein.scenario

import scala.deriving.Mirror

/** A kind of scenario: the names, defaults and parsers of its settings.
  *
  * {{{
  * val patrol = ScenarioKind(Patrol())   // of: case class Patrol(scouts: Int = 2, heightM: Double = 30) extends Scenario
  * }}}
  *
  * @param standard the scenario with all its defaults; a setting is a `String`, a `Boolean` or a number; its
  *   type is that of its default
  */
open class ScenarioKind[A <: Scenario](val standard: A)(using mirror: Mirror.ProductOf[A]):

  def name: String = standard.name

  val settings: Vector[String] = standard.productElementNames.toVector

  private val readers = settings.zip(standard.productIterator.map(Reader.of(name, _)))

  /** Reads a scenario and evaluates all of its definitions once, so that errors surface before the flight.
    *
    * @param values settings by name; missing settings have their defaults
    * @throws skein.units.OwnFailure if the scenario's code throws
    * @return Left lists every mistake: what was expected, and what was given
    */
  def read(values: Map[String, String]): Either[Seq[String], Scenario] =
    val made = candidate(values)
    made.foreach(scenario => Scenario.told(name)(ask(scenario)))
    made

  /** Reads a scenario without evaluating its definitions; for candidates of a search, after a similar
    * scenario was read.
    */
  def candidate(values: Map[String, String]): Either[Seq[String], Scenario] =
    val unknown = values.keys.toSeq.sorted.filterNot(settings.contains).map(name =>
      s"no setting '$name'; the nearest is '${Nearest.to(name, settings)}'"
    )
    val (wrong, right) = readers
      .zip(standard.productIterator)
      .map:
        case ((setting, reader), default) =>
          values.get(setting) match
            case None       => Right(default)
            case Some(text) => reader.read(text).toRight(s"$setting: expected ${reader.what}, got '$text'")
      .partitionMap(identity)
    if unknown.nonEmpty || wrong.nonEmpty then Left(unknown ++ wrong)
    else
      Scenario.told(name):
        val scenario = mirror.fromProduct(Tuple.fromArray(right.toArray))
        val mistakes =
          if scenario.mistakes.isEmpty then Scenario.mistakeOfAgents(scenario).toSeq else scenario.mistakes
        Either.cond(mistakes.isEmpty, scenario, mistakes)

  private def ask(scenario: Scenario): Unit =
    val _ = scenario.title
    val _ = scenario.note
    val _ = scenario.duration
    val _ = scenario.scene
    val _ = settings.map(scenario.recordedAs)
    val _ = scenario.equipment
    val _ = scenario.eyes
    val _ = scenario.limits
    val _ = scenario.series
    val _ = scenario.measures

  /** Reads the scenario of a recording.
    *
    * @param parameters the recorded settings, keyed by name. A missing setting was introduced after the
    *   recording, and has its default
    */
  def ofRecording(parameters: Map[String, String]): Either[Seq[String], Scenario] =
    read(settings.flatMap(setting => parameters.get(standard.recordedAs(setting)).map(setting -> _)).toMap)

/** The parser of one setting.
  *
  * @param what describes the expected value
  */
private final class Reader(val what: String, val read: String => Option[Any])

private object Reader:
  /** The reader for settings with a default of this type. */
  def of(scenario: String, default: Any): Reader = default match
    case _: Int     => Reader("a whole number", _.toIntOption)
    case _: Long    => Reader("a whole number", _.toLongOption)
    case _: Double  => Reader("a number", _.toDoubleOption.filter(_.isFinite))
    case _: Boolean => Reader("true or false", _.toBooleanOption)
    case _: String  => Reader("a text", Some(_))
    case other      =>
      throw IllegalArgumentException(
        s"scenario $scenario: a setting is a number, a truth value or a text, got $other"
      )

/** Finds the known word nearest to a misspelt word. */
object Nearest:
  def to(word: String, known: Seq[String]): String = known.sorted.minBy(distance(word, _))

  /** Number of letters to insert, delete or replace to turn one word into the other. */
  def distance(from: String, to: String): Int =
    val first = Vector.range(0, to.length + 1)
    from.zipWithIndex
      .foldLeft(first): (above, letter) =>
        val (here, row) = letter
        (1 to to.length).foldLeft(Vector(row + 1)): (left, column) =>
          val replaced = above(column - 1) + (if here == to(column - 1) then 0 else 1)
          left :+ replaced.min(above(column) + 1).min(left.last + 1)
      .last
