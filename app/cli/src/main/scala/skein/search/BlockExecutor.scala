package skein.search

import java.util.concurrent.{ConcurrentLinkedQueue, TimeoutException}
import scala.collection.immutable.ArraySeq
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, Future}

/** Computes blocks of work in other processes. */
trait BlockExecutor:
  /** @param onAnswer called with each answer as it arrives, in any order, on any thread
    * @return the answers in the order of the blocks; None if it was cancelled; Left says why there are none
    */
  def compute(
      works: Vector[ArraySeq[Byte]],
      onAnswer: ArraySeq[Byte] => Unit
  ): Future[Either[String, Option[Vector[ArraySeq[Byte]]]]]
  def cancel(): Unit

  /** Gets blocks computed, and blocks the calling thread until then.
    *
    * @param isCancelled checked several times per second; true ends the computation
    * @param onAnswer called with each answer as it arrives, in any order, on the calling thread
    * @param onWait called several times per second on the calling thread
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

/** Thrown when no more blocks can be computed, with the reason. */
final class BlocksFailed(reason: String) extends RuntimeException(reason)
