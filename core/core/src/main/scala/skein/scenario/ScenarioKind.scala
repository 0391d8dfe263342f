package skein.scenario

import scala.deriving.Mirror

/** A kind of scenario: the names of its settings, their defaults, and how they are read.
  *
  * {{{
  * val patrol = ScenarioKind(Patrol())   // of: case class Patrol(scouts: Int = 2, heightM: Double = 30) extends Scenario
  * }}}
  *
  * @param standard with all its defaults; a setting is a `String`, a `Boolean`, a number, and is read as what
  *   its default is
  */
open class ScenarioKind[A <: Scenario](val standard: A)(using mirror: Mirror.ProductOf[A]):

  def name: String = standard.name

  /** Names of all settings, in their order. */
  val settings: Vector[String] = standard.productElementNames.toVector

  private val readers = settings.zip(standard.productIterator.map(Reader.of(name, _)))

  /** Reads it and asks it once for all that it states, so that what fails does so before the flight.
    *
    * @param values settings by name; those that are missing have their defaults
    * @throws skein.units.OwnFailure if the scenario's code throws
    * @return or every mistake: what was expected, and what came
    */
  def read(values: Map[String, String]): Either[Seq[String], Scenario] =
    val made = candidate(values)
    made.foreach(scenario => Scenario.told(name)(ask(scenario)))
    made

  /** The same, but that it is not asked: where a scenario like it was read, as of a search's candidates. */
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
            case Some(text) => reader.read(text).toRight(s"$setting: expected ${reader.what}, came '$text'")
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

  /** @param parameters of a recording, by name. A setting that it does not have was added since, and takes its
    *   default
    */
  def ofRecording(parameters: Map[String, String]): Either[Seq[String], Scenario] =
    read(settings.flatMap(setting => parameters.get(standard.recordedAs(setting)).map(setting -> _)).toMap)

/** How one setting is read.
  *
  * @param what is expected
  */
private final class Reader(val what: String, val read: String => Option[Any])

private object Reader:
  /** As what a default is. */
  def of(scenario: String, default: Any): Reader = default match
    case _: Int     => Reader("a whole number", _.toIntOption)
    case _: Long    => Reader("a whole number", _.toLongOption)
    case _: Double  => Reader("a number", _.toDoubleOption.filter(_.isFinite))
    case _: Boolean => Reader("true or false", _.toBooleanOption)
    case _: String  => Reader("a text", Some(_))
    case other      =>
      throw IllegalArgumentException(
        s"scenario $scenario: a setting is a number, a truth value or a text, came $other"
      )

/** Which of some words a misspelt one is nearest to. */
object Nearest:
  def to(word: String, known: Seq[String]): String = known.sorted.minBy(distance(word, _))

  /** How many letters must be inserted, left out or replaced. */
  def distance(from: String, to: String): Int =
    val first = Vector.range(0, to.length + 1)
    from.zipWithIndex
      .foldLeft(first): (above, letter) =>
        val (here, row) = letter
        (1 to to.length).foldLeft(Vector(row + 1)): (left, column) =>
          val replaced = above(column - 1) + (if here == to(column - 1) then 0 else 1)
          left :+ replaced.min(above(column) + 1).min(left.last + 1)
      .last
