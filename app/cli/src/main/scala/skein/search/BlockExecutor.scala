package skein.search

import java.util.concurrent.{ConcurrentLinkedQueue, TimeoutException}
import scala.collection.immutable.ArraySeq
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, Future}

/** Computes blocks in other processes. */
trait BlockExecutor:
  /** @param onAnswer told each as it comes, in any order, on any thread
    * @return the answers in the order of the works; none if it was cancelled; or why there are none
    */
  def compute(
      works: Vector[ArraySeq[Byte]],
      onAnswer: ArraySeq[Byte] => Unit
  ): Future[Either[String, Option[Vector[ArraySeq[Byte]]]]]
  def cancel(): Unit

  /** Has works computed, and blocks the calling thread meanwhile.
    *
    * @param isCancelled asked a few times a second; what is under way is given up then
    * @param onAnswer told each as it comes, in any order, by the calling thread
    * @param onWait called a few times a second by the calling thread
    */
  final def computed(
      works: Vector[ArraySeq[Byte]],
      isCancelled: () => Boolean = () => false,
      onAnswer: ArraySeq[Byte] => Unit = _ => ()
  )(onWait: => Unit): Either[String, Option[Vector[ArraySeq[Byte]]]] =
    val came      = ConcurrentLinkedQueue[ArraySeq[Byte]]()
    val answered  = compute(works, answer => { val _ = came.add(answer) })
    def tellAll() = Iterator.continually(came.poll()).takeWhile(_ != null).foreach(onAnswer)
    var isGivenUp = false
    while !answered.isCompleted do
      try Await.ready(answered, 200.millis): Unit
      catch
        case _: TimeoutException =>
          if !isGivenUp && isCancelled() then
            isGivenUp = true
            cancel()
          tellAll()
          onWait
    tellAll()
    Await.result(answered, 1.second)

/** No more blocks are computed: for the reason told. */
final class BlocksFailed(reason: String) extends RuntimeException(reason)
