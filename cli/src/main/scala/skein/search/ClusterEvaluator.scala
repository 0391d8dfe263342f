package skein.search

import java.util.concurrent.TimeoutException
import scala.collection.immutable.ArraySeq
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, Future}
import skein.optimise.{Evaluator, RunningStats}

/** Whoever computes blocks, elsewhere. */
trait Elsewhere:
  /** @return the answers in the order of the works; none if it was cancelled; or why there are none */
  def compute(works: Vector[ArraySeq[Byte]]): Future[Either[String, Option[Vector[ArraySeq[Byte]]]]]
  def cancel(): Unit

/** No more blocks are computed: for the reason told. */
final class ElsewhereFailed(reason: String) extends RuntimeException(reason)

/** Has candidates judged elsewhere, in blocks: to the same bits as [[skein.optimise.ValueEvaluator]] judges them here.
  * Blocks the calling thread meanwhile.
  *
  * @param atMost
  *   episodes of a block
  * @param onWait
  *   called a few times a second by the thread that waits, with the call's episodes over all candidates
  */
final class ClusterEvaluator(elsewhere: Elsewhere, judge: Judge, atMost: Int, onWait: Long => Unit)
    extends Evaluator:

  /** A round at once: there are always enough workers. */
  override def sideBySide: Int = 1 << 30

  def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats] =
    talliesUnless(() => false)(candidates, episodes).get

  /** @throws ElsewhereFailed
    *   where there can be no answer
    */
  override def talliesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[RunningStats]] =
    val blocks    = SearchBlock.cut(judge, candidates, episodes, atMost)
    val answered  = elsewhere.compute(blocks.map(_.bytes))
    var isGivenUp = false
    while !answered.isCompleted do
      try Await.ready(answered, 200.millis): Unit
      catch
        case _: TimeoutException =>
          if !isGivenUp && isCancelled() then
            isGivenUp = true
            elsewhere.cancel()
          onWait(candidates.size.toLong * episodes.size)
    Await
      .result(answered, 1.second)
      .flatMap:
        case None          => Right(None)
        case Some(answers) => SearchBlock.together(blocks, answers, episodes.size).map(Some(_))
      .fold(reason => throw ElsewhereFailed(reason), identity)
