package skein.search

import skein.optimise.{Evaluator, RunningStats}

/** Judges as another does, and notes what flies the candidates: their policies may be of several forms. One call at a
  * time.
  *
  * @param engine
  *   of a candidate, in a line for the user
  */
final class NotedEvaluator(by: Evaluator, engine: Vector[Double] => String) extends Evaluator:
  private val engines = collection.mutable.LinkedHashMap.empty[Vector[Double], String]

  override def sideBySide: Int = by.sideBySide

  def tallies(of: Vector[Vector[Double]], episodes: Range): Vector[RunningStats] =
    note(of)
    by.tallies(of, episodes)

  override def talliesUnless(isCancelled: () => Boolean)(
      of: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[RunningStats]] =
    note(of)
    by.talliesUnless(isCancelled)(of, episodes)

  /** A candidate that is judged in several rounds counts once. */
  private def note(of: Vector[Vector[Double]]): Unit =
    of.foreach(each => engines.getOrElseUpdate(each, engine(each)): Unit)

  /** How many candidates were flown by something else than this, in a line for the user. */
  def others(expected: String): Option[String] =
    val others = engines.values.filter(_ != expected).groupMapReduce(identity)(_ => 1)(_ + _).toVector.sorted
    Option.when(others.nonEmpty):
      val told = others.map((engine, count) => s"$count by another engine, $engine")
      s"of ${engines.size} candidates judged ${told.mkString("; ")}"
