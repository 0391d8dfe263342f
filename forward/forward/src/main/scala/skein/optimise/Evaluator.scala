package skein.optimise

/** Evaluates candidates for a [[Search]]. All candidates use equal episodes (common random numbers), so that
  * differences between them are their own.
  */
trait Evaluator:

  /** The objective's mean and spread over these episodes for each candidate. A pure function: a candidate's
    * tally depends only on the candidate and the episodes, to the bit, not on other candidates of the call.
    *
    * @param episodes numbers of the episodes, at least one
    */
  def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats]

  /** Number of candidates that take no longer than one. */
  def sideBySide: Int = 1

  /** The tallies, or None if it was cancelled.
    *
    * @param isCancelled polled repeatedly, from any thread
    */
  def talliesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[RunningStats]] =
    val all = tallies(candidates, episodes)
    Option.when(!isCancelled())(all)

/** An evaluator that returns single values, so that a candidate's episodes too can be distributed: combined
  * values give an identical tally, to the bit.
  */
trait ValueEvaluator extends Evaluator:

  /** The objective's values of each candidate, by its episodes; or None if it was cancelled.
    *
    * @param isCancelled polled repeatedly, from any thread
    */
  def valuesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[Array[Double]]]

  def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats] =
    talliesUnless(() => false)(candidates, episodes).get

  override def talliesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[RunningStats]] =
    valuesUnless(isCancelled)(candidates, episodes).map(_.map(values =>
      RunningStats.of(values.length)(values(_))
    ))
