package skein.search

import skein.lanes.Engine
import skein.optimise.{Evaluator, RunningStats}

/** Delegates to another evaluator, and records each candidate's engine, since policies may have different
  * forms. One call at a time.
  *
  * @param engine the engine of a candidate
  */
final class NotedEvaluator(by: Evaluator, engine: Vector[Double] => Engine) extends Evaluator:
  private val candidates = collection.mutable.LinkedHashMap.empty[Engine, Int].withDefaultValue(0)

  override def sideBySide: Int = by.sideBySide

  def tallies(of: Vector[Vector[Double]], episodes: Range): Vector[RunningStats] =
    note(of, episodes)
    by.tallies(of, episodes)

  override def talliesUnless(isCancelled: () => Boolean)(
      of: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[RunningStats]] =
    note(of, episodes)
    by.talliesUnless(isCancelled)(of, episodes)

  /** Records the engines. If a candidate is evaluated in several rounds, only the one with the first episode
    * counts.
    */
  private def note(of: Vector[Vector[Double]], episodes: Range): Unit =
    if episodes.start == 0 then of.foreach(each => candidates(engine(each)) += 1)

  /** A line for the user with the number of candidates that another engine than the expected one evaluated.
    */
  def others(expected: Engine): Option[String] =
    val others = candidates.toVector.filter(_._1 != expected)
    Option.when(others.nonEmpty):
      val told = others.map((engine, count) => s"$count by another engine, $engine")
      s"of ${candidates.values.sum} candidates judged ${told.mkString("; ")}"
