package skein.search

import skein.optimise.{Evaluator, RunningStats}

/** Evaluates candidates in other processes, in blocks, with the bits of [[skein.optimise.ValueEvaluator]] in
  * this one. Blocks the calling thread.
  *
  * @param atMost maximum number of episodes in a block
  * @param onWait called several times per second on the waiting thread, with the number of the call's
  *   episodes over all candidates
  */
final class ClusterEvaluator(elsewhere: BlockExecutor, judge: Judge, atMost: Int, onWait: Long => Unit)
    extends Evaluator:

  /** A whole round in one call: the workers share its blocks. */
  override def sideBySide: Int = 1 << 30

  def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats] =
    talliesUnless(() => false)(candidates, episodes).get

  /** @throws BlocksFailed if there can be no answer */
  override def talliesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[RunningStats]] =
    val blocks = SearchBlock.cut(judge, candidates, episodes, atMost)
    elsewhere
      .computed(blocks.map(_.bytes), isCancelled):
        onWait(candidates.size.toLong * episodes.size)
      .flatMap:
        case None          => Right(None)
        case Some(answers) => SearchBlock.together(blocks, answers, episodes.size).map(Some(_))
      .fold(reason => throw BlocksFailed(reason), identity)
