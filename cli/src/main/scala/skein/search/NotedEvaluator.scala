package skein.search

import skein.optimise.{Evaluator, RunningStats}

/** Judges as another does, and notes what flies the candidates: their policies may be of several forms. One call at a
  * time.
  *
  * @param engine
  *   of a candidate, in a line for the user
  */
final class NotedEvaluator(by: Evaluator, engine: Vector[Double] => String) extends Evaluator:
  private val candidates = collection.mutable.LinkedHashMap.empty[String, Int].withDefaultValue(0)

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

  private def note(of: Vector[Vector[Double]]): Unit = of.foreach(each => candidates(engine(each)) += 1)

  /** How often candidates were flown by something else than this, in a line for the user. */
  def others(expected: String): Option[String] =
    val others = candidates.toVector.filter(_._1 != expected)
    Option.when(others.nonEmpty):
      val told = others.map((engine, times) => s"$times by another engine, $engine")
      s"of ${candidates.values.sum} candidates judged ${told.mkString("; ")}"
