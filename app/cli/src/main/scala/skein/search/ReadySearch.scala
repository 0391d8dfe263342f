package skein.search

import skein.lanes.{Accelerator, Engine}
import skein.optimise.{Evaluator, RunningStats, Search, SearchMethod, ValueEvaluator, WeightedSum}
import skein.policy.SearchSpace

/** A search whose question was read: whoever reads the same question judges with the same bits. */
trait ReadySearch:
  def search: Search
  def space: SearchSpace
  def durationS: Double
  def periodMs: Double

  /** What flies, for people, and in a word. */
  def vehicles: String
  def model: String

  /** The objective as users write it, with its direction, and without. */
  def text: String
  def formula: String

  /** Of the value; empty where its terms differ. */
  def unit: String

  /** Of what is searched: a policy family, a scenario. */
  def name: String

  /** Who is searched, and against whom.
    *
    * @param axes what is searched of it
    */
  def subject(axes: String): String

  /** A candidate for people. */
  def label(candidate: Vector[Double]): String

  def baseline: Baseline

  /** What judges in this process, one call at a time. */
  def judges(threads: Int): Judge => ValueEvaluator

  /** Of a candidate and of the baseline; or none if it was cancelled. */
  def measured(
      by: Judge => Evaluator,
      candidate: Vector[Double],
      episodes: Range,
      isCancelled: () => Boolean
  ): Option[(RunningStats, RunningStats)]

  /** What a candidate comes to by the scalar reference; none where that flies it anyhow, or nothing forward.
    */
  def reference(candidate: Vector[Double], episodes: Range): Option[RunningStats]

  /** What flies a candidate, or the baseline, where it is judged. */
  def engine(candidate: Vector[Double], judge: Judge): Engine

  /** What flies the candidates, and where it is something else, what flies the winner's fresh episodes and
    * the baseline's.
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
  protected final def shares(by: SearchMethod, accelerator: Option[Accelerator], alone: Engine): Boolean =
    accelerator.nonEmpty || by.together(space.dimension) >= ReadySearch.ShareFrom || !alone.isFast

  /** How many episodes are flown in a second, for people; where that is few, by flying one. */
  def rate(threads: Int): Option[String] = None

  /** Whether forward simulation flies it, and not flights in virtual time. */
  def fliesForward: Boolean = true

  def effort: Effort

  /** Episodes of a block of work for others: about half a second of one core's. */
  def blockEpisodes: Int

  /** Fresh episodes on which the winner is measured, where the user chose. */
  def fresh: Option[Int]

  /** What was found, as a file that `./skein fly` takes: its name and its text. */
  def file(found: Found): (String, String)

  /** The method, the loop and the link, by their names. */
  def method: String
  def loop: String
  def link: String

  final def under: String = s"$loop over $link"

  def title: String = s"$name, $under"

  /** For an axis of a picture. */
  def measure: String = WeightedSum.withUnit(formula, unit)

object ReadySearch:
  private val ShareFrom = 256
