package skein.experiment

import scala.concurrent.Future
import skein.airsim.{AirSimClient, Multirotor}
import skein.loop.{Craft, Stepper}
import skein.rpc.RpcError
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** A multirotor of AirSim as a loop sees it. */
final class MultirotorCraft(multirotor: Multirotor) extends Craft:
  def read(): Future[Either[RpcError, Stamped[Kinematics]]] = multirotor.kinematics()

  def move(velocityNed: Vector3, down: Metres, duration: Span): Future[Either[RpcError, Boolean]] =
    multirotor.moveByVelocityZ(velocityNed, down, duration)

  def hover(): Future[Either[RpcError, Boolean]] = multirotor.hover()

/** AirSim's own pause and steps. */
final class AirSimStepper(client: AirSimClient) extends Stepper:
  def pause(): Future[Either[RpcError, Unit]]                 = client.pause()
  def resume(): Future[Either[RpcError, Unit]]                = client.resume()
  def continueFor(span: Span): Future[Either[RpcError, Unit]] = client.continueFor(span)
