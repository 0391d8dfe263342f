package skein.experiment

import java.util.concurrent.atomic.{AtomicInteger, AtomicReference}
import org.apache.pekko.actor.{ActorSystem, Cancellable}
import scala.concurrent.{Future, Promise}
import skein.airsim.{AirSimClient, Multirotor}
import skein.loop.{Craft, Stepper}
import skein.rpc.RpcError
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** A multirotor of AirSim as a loop sees it.
  *
  * AirSim answers a move when the next one arrives. If that answer is lost on a connection that lives, a loop that keeps
  * to two outstanding moves would send nothing until the call's timeout, the move's whole duration and more. Sending a
  * third move on suspicion could freeze the simulator, should the second be on its way still. So the vehicle is asked for
  * a sign of life behind the second one, on the same ordered connection: when that is answered, the second has arrived
  * and has replaced the first, and [[MultirotorCraft.Settles]] later the first answer is taken for lost, and for what it
  * must have been: false, replaced. Control goes on [[MultirotorCraft.AnswerWithin]], a round trip and `Settles` after the
  * second move was sent; where the sign of life is lost too, after the timeout of that more.
  *
  * @param onLost
  *   told of every answer taken for lost
  */
final class MultirotorCraft(multirotor: Multirotor, onLost: String => Unit)(using system: ActorSystem)
    extends Craft:
  import MultirotorCraft.*
  import system.dispatcher

  private val newest = AtomicReference(Option.empty[Sent])
  private val asked  = AtomicInteger()

  /** How often it was asked for a sign of life. */
  def signsAskedFor: Int = asked.get

  def read(): Future[Either[RpcError, Stamped[Kinematics]]] = multirotor.kinematics()

  def move(velocityNed: Vector3, down: Metres, duration: Span): Future[Either[RpcError, Boolean]] =
    val withdrawn = Promise[Unit]()
    val called    =
      multirotor.moveByVelocityZ(velocityNed, down, duration, withdrawn = Some(withdrawn.future))
    val answer = called.map:
      case Left(_: RpcError.Timeout) if withdrawn.isCompleted => Right(false)
      case result                                             => result
    replaceBy(Some(Sent(answer, withdrawn)))
    answer

  def hover(): Future[Either[RpcError, Boolean]] =
    val answer = multirotor.hover()
    replaceBy(None)
    answer

  private def replaceBy(next: Option[Sent]): Unit =
    for replaced <- newest.getAndSet(next) if !replaced.answer.isCompleted do
      val watch = later(AnswerWithin)(doubt(replaced))
      replaced.answer.onComplete(_ => watch.cancel())

  private def doubt(replaced: Sent): Unit = if !replaced.answer.isCompleted then
    asked.incrementAndGet(): Unit
    multirotor
      .reached()
      .foreach:
        case Right(_) => later(Settles)(giveUp(replaced)): Unit
        case Left(_)  => later(Settles)(doubt(replaced)): Unit

  private def giveUp(replaced: Sent): Unit =
    if !replaced.answer.isCompleted && replaced.withdrawn.trySuccess(()) then
      onLost("a replaced move was not answered: its answer is taken for lost")

  private def later(span: Span)(act: => Unit): Cancellable =
    system.scheduler.scheduleOnce(span.toDuration)(act)

object MultirotorCraft:
  /** From the sending of a move until the answer to the one that it replaces is missed. */
  val AnswerWithin: Span = Span.ofMillis(500)

  /** That AirSim has to end a replaced move; it takes 0.3 ms. */
  val Settles: Span = Span.ofMillis(100)

  private final case class Sent(answer: Future[Either[RpcError, Boolean]], withdrawn: Promise[Unit])

/** AirSim's own pause and steps. */
final class AirSimStepper(client: AirSimClient) extends Stepper:
  def pause(): Future[Either[RpcError, Unit]]                 = client.pause()
  def resume(): Future[Either[RpcError, Unit]]                = client.resume()
  def continueFor(span: Span): Future[Either[RpcError, Unit]] = client.continueFor(span)
