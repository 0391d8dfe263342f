package skein.experiment

import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.*
import skein.policy.{Agent, Scenario}
import skein.units.*

/** Brings a scenario's vehicles to their starts: at rest, hovering, under api control. */
final class Preparation(client: AirSimClient)(using ExecutionContext):

  /** Puts the vehicles there at once. For the built-in simulator, which lets an armed vehicle hover where it is put. */
  def place(scenario: Scenario): Future[Either[AirSimError, Vector[Multirotor]]] =
    everyVehicle(scenario): (vehicle, agent) =>
      ready(vehicle).flatMap(_ =>
        call(vehicle.setPose(VehiclePose(agent.startPositionNed, Quaternion.Identity)))
      )

  /** Takes off and flies there, all vehicles at once. For any simulator. */
  def climb(scenario: Scenario): Future[Either[AirSimError, Vector[Multirotor]]] =
    everyVehicle(scenario): (vehicle, agent) =>
      for
        _ <- ready(vehicle)
        // AirSim stops short of the take-off height and answers false; the position is what counts.
        _ <- call(vehicle.takeoff())
        _ <- call(vehicle.moveToPosition(agent.startPositionNed, Preparation.ClimbSpeed))
        _ <- call(vehicle.hover())
      yield ()

  private def everyVehicle(scenario: Scenario)(
      prepare: (Multirotor, Agent) => Future[Unit]
  ): Future[Either[AirSimError, Vector[Multirotor]]] =
    Future
      .sequence(
        scenario.agents.map(agent =>
          client
            .multirotor(agent.name)
            .flatMap:
              case Left(error)    => Future.failed(NotReady(error))
              case Right(vehicle) => prepare(vehicle, agent).map(_ => vehicle)
        )
      )
      .map(Right(_))
      .recover { case NotReady(error) => Left(error) }

  private def ready(vehicle: Multirotor): Future[Unit] =
    for
      _ <- call(vehicle.enableApiControl())
      _ <- call(vehicle.arm())
    yield ()

  private def call[A](answer: Future[Either[skein.rpc.RpcError, A]]): Future[A] = answer.map:
    case Right(value) => value
    case Left(error)  => throw NotReady(AirSimError.Call(error))

  /** Carries an expected error out of a chain of calls. */
  private case class NotReady(error: AirSimError) extends RuntimeException(error.message)

object Preparation:
  private val ClimbSpeed = MetresPerSecond(5)
