package skein.search

import skein.lanes.{Accelerator, Engine}
import skein.optimise.{Evaluator, RunningStats, Search, SearchMethod, ValueEvaluator, WeightedSum}
import skein.policy.SearchSpace

/** A search whose question is resolved: processes that resolve equal questions evaluate with identical bits.
  */
trait ReadySearch:
  def search: Search
  def space: SearchSpace
  def durationS: Double
  def periodMs: Double

  /** The vehicle model: in a line for people, and in a word. */
  def vehicles: String
  def model: String

  /** The objective as users write it: with its direction, and without. */
  def text: String
  def formula: String

  /** The objective's unit; empty where its terms differ. */
  def unit: String

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

  /** Statistics of a candidate and of the baseline; None if it was cancelled. */
  def measured(
      by: Judge => Evaluator,
      candidate: Vector[Double],
      episodes: Range,
      isCancelled: () => Boolean
  ): Option[(RunningStats, RunningStats)]

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

  /** Names of the method, the loop and the link. */
  def method: String
  def loop: String
  def link: String

  final def under: String = s"$loop over $link"

  def title: String = s"$name, $under"

  /** The objective with its unit, for the axis of a picture. */
  def measure: String = WeightedSum.withUnit(formula, unit)

object ReadySearch:
  private val ShareFrom = 256
