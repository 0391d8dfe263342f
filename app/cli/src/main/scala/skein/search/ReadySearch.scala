package skein.search

import skein.lanes.{Accelerator, Engine}
import skein.optimise.*
import skein.policy.SearchSpace
import skein.scenario.Scenarios

/** A search's question in the user's words: enough to continue it, or to repeat it. */
trait PosedSearch:
  def method: String
  def conditions: Conditions
  def link: String

  /** @return Left states what was expected, what was given, and in which option */
  def setup(using Scenarios): Either[String, ReadySearch]

  /** The names in the question, some of which may be those of files. */
  final def named: Seq[String] = Seq(link, conditions.plant) ++ conditions.eye

/** A search whose question is resolved: processes that resolve equal questions evaluate with identical bits.
  */
trait ReadySearch:
  val question: PosedSearch
  def search: Search
  def space: SearchSpace
  val objective: SummedMeasures[?]

  /** The vehicle model: in a line for people, and in a word. */
  def vehicles: String
  def model: String

  /** This search with an accelerator that simulates its candidates. */
  def acceleratedBy(accelerator: Option[Accelerator]): ReadySearch

  /** Name of the policy family or scenario that is searched. */
  def name: String

  /** The subject of the search and its opponent, in a line.
    *
    * @param axes the searched parameters
    */
  def subject(axes: String): String

  /** Describes a candidate's parameters for people. */
  def label(candidate: Vector[Double]): String

  def baseline: Baseline

  /** Evaluators in this process, for one call at a time. */
  def judges(threads: Int): Judge => ValueEvaluator

  /** A candidate's statistics by the scalar reference; None where that is the engine anyhow, or forward
    * simulation cannot be used.
    */
  def reference(candidate: Vector[Double], episodes: Range): Option[RunningStats]

  /** What flies a candidate, or the baseline, where it is judged. */
  def engine(candidate: Vector[Double], judge: Judge): Engine

  /** Describes the engine of the candidates, and if they differ, those of the winner's fresh episodes and of
    * the baseline.
    */
  final def engines: String =
    val together = engine(space.defaults, Judge.Candidates)
    val fresh    =
      Vector(engine(space.defaults, Judge.Winner), engine(baseline.candidate, Judge.Baseline)).distinct
    together.text + (if fresh == Vector(together) then ""
                     else fresh.mkString("; fresh episodes: ", "; the baseline's: ", ""))

  /** Whether candidates share episodes: an episode's timetable costs as much as it saves some hundred
    * candidates, so few fly faster each with delays of its own.
    *
    * @param alone what flies them so
    * @param accelerator flies shared episodes only
    */
  protected final def shares(by: SearchMethod, accelerator: Option[Accelerator], alone: => Engine): Boolean =
    accelerator.nonEmpty || by.together(space.dimension) >= ReadySearch.ShareFrom || !alone.isFast

  /** How many episodes are flown in a second, for people; where that is few, by flying one. */
  def rate(threads: Int): Option[String] = None

  /** Whether it uses forward simulation, and not flights in virtual time. */
  def fliesForward: Boolean = true

  def effort: Effort

  /** Episodes of a block of work for other processes: about half a second of one core. */
  def blockEpisodes: Int

  /** Fresh episodes for the winner, if the user chose. */
  def fresh: Option[Int]

  /** The result as a file that `./skein fly` accepts: its name and its text. */
  def file(found: Found): (String, String)

  export objective.{formula, text, unit}
  export question.{link, method}
  final def loop: String      = question.conditions.loopText
  final def durationS: Double = question.conditions.durationS
  final def periodMs: Double  = question.conditions.periodMs

  final def under: String = s"$loop over $link"

  def title: String = s"$name, $under"

  /** The objective with its unit, for the axis of a picture. */
  def measure: String = WeightedSum.withUnit(formula, unit)

object ReadySearch:
  private val ShareFrom = 256
