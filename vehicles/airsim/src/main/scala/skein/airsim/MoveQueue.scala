package skein.airsim

import java.util.concurrent.atomic.{AtomicInteger, AtomicReference}
import org.apache.pekko.actor.{ActorSystem, Cancellable}
import scala.concurrent.{Future, Promise}
import skein.rpc.RpcError
import skein.units.*

/** The moves of one vehicle that AirSim has not answered yet, and what is done where an answer is missed.
  *
  * AirSim answers a move when the next one arrives, which cancels it. Two things go wrong with that, and look
  * alike:
  *   - The answer is lost on a connection that lives. The next move flies.
  *   - The cancel is lost: it came while AirSim was about to begin the move. That one flies on to its end,
  *     and the next waits behind it. One move more, sent on suspicion, would cancel the first and wait behind
  *     the second: from then on each move would begin when the one after it comes, for the rest of the
  *     flight.
  *
  * So, when the answer to a replaced move is missed for [[MoveQueue.AnswerWithin]], the vehicle is asked for
  * a sign of life behind the next move, on the same ordered connection. When that has come and the answer has
  * not, the vehicle's task is cancelled once more, which adds no move to AirSim's queue: where a cancel was
  * lost, the replaced move ends and the next begins; where the answer was lost, the next one ends, and the
  * loop sends another. Only if [[MoveQueue.Settles]] after that nothing was heard of the replaced move, its
  * answer is taken for lost and for what it must have been: false, replaced. Where the sign of life is lost
  * too, all this begins again.
  *
  * @param onLost told of every answer that was missed, and what became of it
  */
final class MoveQueue(multirotor: Multirotor, onLost: String => Unit)(using system: ActorSystem):
  import MoveQueue.*
  import system.dispatcher

  private val newest = AtomicReference(Option.empty[Sent])
  private val asked  = AtomicInteger()

  /** Calls that were made beside the moves: signs of life and cancels. */
  def callsBeside: Int = asked.get

  /** Sends a move, which replaces the one before.
    *
    * @param call is told when its answer need not be waited for any longer
    */
  def send(call: Future[Unit] => Future[Either[RpcError, Boolean]]): Future[Either[RpcError, Boolean]] =
    val withdrawn = Promise[Unit]()
    val answer    = call(withdrawn.future).map:
      case Left(_: RpcError.Timeout) if withdrawn.isCompleted => Right(false)
      case result                                             => result
    for replaced <- newest.getAndSet(Some(Sent(answer, withdrawn))) if !replaced.answer.isCompleted do
      val watch = later(AnswerWithin)(doubt(replaced))
      replaced.answer.onComplete(_ => watch.cancel())
    answer

  private def doubt(replaced: Sent): Unit =
    beside(replaced)(_.reached()):
      case Right(_) => later(Settles)(cancel(replaced)): Unit
      case Left(_)  => later(Settles)(doubt(replaced)): Unit

  private def cancel(replaced: Sent): Unit =
    beside(replaced)(_.cancelLastTask()):
      case Right(_) =>
        for answer <- replaced.answer if answer.isRight && !replaced.withdrawn.isCompleted do
          onLost("a replaced move flew on, its cancel lost: it was cancelled again")
        later(Settles)(giveUp(replaced)): Unit
      case Left(_) => later(Settles)(doubt(replaced)): Unit

  private def giveUp(replaced: Sent): Unit =
    if !replaced.answer.isCompleted && replaced.withdrawn.trySuccess(()) then
      onLost("a replaced move was not answered: its answer is taken for lost")

  /** A call beside the moves, unless it is needed no more. */
  private def beside(replaced: Sent)(call: Multirotor => Future[Either[RpcError, Unit]])(
      next: Either[RpcError, Unit] => Unit
  ): Unit = if !replaced.answer.isCompleted then
    asked.incrementAndGet(): Unit
    call(multirotor).foreach(next)

  private def later(span: Span)(act: => Unit): Cancellable =
    system.scheduler.scheduleOnce(span.toDuration)(act)

object MoveQueue:
  /** From the sending of a move until the answer to the one that it replaces is missed. */
  val AnswerWithin: Span = Span.ofMillis(500)

  /** That AirSim has to end a replaced move; it takes 0.3 ms. */
  val Settles: Span = Span.ofMillis(100)

  private final case class Sent(answer: Future[Either[RpcError, Boolean]], withdrawn: Promise[Unit])
