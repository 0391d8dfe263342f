package skein.torture

import scala.collection.mutable
import scala.concurrent.{ExecutionContext, Future}
import skein.link.Clock
import skein.loop.{Craft, Stepper}
import skein.rpc.RpcError
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** A move as the loop sent it. */
final case class Sending(at: Instant, north: Float, east: Float)

/** A craft that keeps account of every call: how it began, that it ended, how many were outstanding. */
final class WatchedCraft(craft: Craft, clock: Clock)(using ExecutionContext) extends Craft:
  private val moves = mutable.ArrayBuffer.empty[Sending]

  val reads, commands = CallCount()
  var hovers          = 0

  def sendings: Vector[Sending] = moves.toVector

  def read(): Future[Either[RpcError, Stamped[Kinematics]]] = reads.count(craft.read())

  def move(velocityNed: Vector3, down: Metres, duration: Span): Future[Either[RpcError, Boolean]] =
    moves += Sending(clock.now(), velocityNed.x.toFloat, velocityNed.y.toFloat)
    commands.count(craft.move(velocityNed, down, duration))

  def hover(): Future[Either[RpcError, Boolean]] =
    hovers += 1
    commands.count(craft.hover())

/** A stepper that counts its calls. */
final class WatchedStepper(stepper: Stepper)(using ExecutionContext) extends Stepper:
  val calls = CallCount()

  def pause(): Future[Either[RpcError, Unit]]                 = calls.count(stepper.pause())
  def resume(): Future[Either[RpcError, Unit]]                = calls.count(stepper.resume())
  def continueFor(span: Span): Future[Either[RpcError, Unit]] = calls.count(stepper.continueFor(span))

/** Calls begun and ended. */
final class CallCount:
  var begun, ended, most = 0

  def count[A](call: Future[A])(using ExecutionContext): Future[A] =
    begun += 1
    most = most.max(begun - ended)
    call.andThen(_ => ended += 1)
