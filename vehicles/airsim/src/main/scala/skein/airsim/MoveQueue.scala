package skein.airsim

import java.util.concurrent.atomic.{AtomicInteger, AtomicReference}
import org.apache.pekko.actor.{ActorSystem, Cancellable}
import scala.concurrent.{Future, Promise}
import skein.rpc.RpcError
import skein.units.*

/** The moves of one vehicle that AirSim has not answered yet, and the recovery when an answer is missed.
  *
  * AirSim answers a move when the next one arrives, which cancels it. Two failures look alike:
  *   - The answer is lost on a live connection. The next move flies.
  *   - The cancel is lost: it arrived while AirSim was about to begin the move. That move flies to its end,
  *     and the next waits behind it. Sending one more move on suspicion would cancel the first and wait
  *     behind the second: from then on each move would begin when its successor arrives, for the rest of the
  *     flight.
  *
  * So when the answer to a replaced move has been missing for [[MoveQueue.AnswerWithin]], a probe is sent
  * behind the next move, on the same ordered connection. If the probe is answered and the move is not, the
  * vehicle's task is cancelled once more, which adds no move to AirSim's queue: after a lost cancel, the
  * replaced move ends and the next begins; after a lost answer, the next move ends, and the loop sends
  * another. If the answer is still missing [[MoveQueue.Settles]] later, it is taken as lost and replaced by
  * the answer it must have been: false, replaced. If the probe's answer is lost too, the procedure starts
  * again.
  *
  * @param onLost called with one line for each missed answer: what happened to it
  */
final class MoveQueue(multirotor: Multirotor, onLost: String => Unit)(using system: ActorSystem):
  import MoveQueue.*
  import system.dispatcher

  private val newest = AtomicReference(Option.empty[Sent])
  private val asked  = AtomicInteger()

  /** Calls sent in addition to the moves: probes and cancels. */
  def callsBeside: Int = asked.get

  /** Sends a move, which replaces the one before.
    *
    * @param call makes the call, given a future that completes when its answer need no longer be awaited
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

  /** Sends a call in addition to the moves, unless it is no longer needed. */
  private def beside(replaced: Sent)(call: Multirotor => Future[Either[RpcError, Unit]])(
      next: Either[RpcError, Unit] => Unit
  ): Unit = if !replaced.answer.isCompleted then
    asked.incrementAndGet(): Unit
    call(multirotor).foreach(next)

  private def later(span: Span)(act: => Unit): Cancellable =
    system.scheduler.scheduleOnce(span.toDuration)(act)

object MoveQueue:
  /** Time from sending a move until the replaced move's answer counts as missing. */
  val AnswerWithin: Span = Span.ofMillis(500)

  /** Time that AirSim has to end a replaced move; it needs 0.3 ms. */
  val Settles: Span = Span.ofMillis(100)

  private final case class Sent(answer: Future[Either[RpcError, Boolean]], withdrawn: Promise[Unit])
