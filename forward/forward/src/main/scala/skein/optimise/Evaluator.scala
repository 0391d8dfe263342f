package skein.optimise

/** Evaluates candidates for a [[Search]]. All candidates use equal episodes (common random numbers), so that
  * different results come from the candidates only.
  */
trait Evaluator:

  /** The objective's mean and spread over these episodes for each candidate. A pure function: a candidate's
    * tally depends only on the candidate and the episodes, to the bit, and not on the other candidates of the
    * call.
    *
    * @param episodes indices of the episodes, at least one
    */
  def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats]

  /** Number of candidates that are evaluated in the time of one. */
  def sideBySide: Int = 1

  /** [[tallies]], or None if the evaluation was cancelled.
    *
    * @param isCancelled polled repeatedly, from any thread
    */
  def talliesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[RunningStats]] =
    val all = tallies(candidates, episodes)
    Option.when(!isCancelled())(all)

/** An evaluator that returns single values, so that the episodes of one candidate can be distributed too. The
  * values combine to an identical tally, to the bit.
  */
trait ValueEvaluator extends Evaluator:

  /** The objective's values of each candidate, in the order of the episodes; None if the evaluation was
    * cancelled.
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
