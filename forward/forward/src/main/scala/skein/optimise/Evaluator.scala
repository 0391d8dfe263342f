package skein.optimise

/** Judges candidates for a [[Search]]. All candidates meet the same episodes (common random numbers), so that
  * their differences are their own.
  */
trait Evaluator:

  /** The objective's mean and spread over these episodes for each candidate. A pure function: a candidate's
    * tally depends on the candidate and the episodes alone, to the bit, whatever else the call holds.
    *
    * @param episodes numbers of the episodes, at least one
    */
  def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats]

  /** So many candidates take no longer than one. */
  def sideBySide: Int = 1

  /** The same, or none if it was cancelled.
    *
    * @param isCancelled asked now and then, from any thread
    */
  def talliesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[RunningStats]] =
    val all = tallies(candidates, episodes)
    Option.when(!isCancelled())(all)

/** An evaluator that tells single values, so that a candidate's episodes too can be parted among many: values
  * put together again give the same tally, to the bit.
  */
trait ValueEvaluator extends Evaluator:

  /** The objective's values of each candidate, by its episodes; or none if it was cancelled.
    *
    * @param isCancelled asked now and then, from any thread
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
