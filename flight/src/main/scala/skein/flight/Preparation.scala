package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.airsim.*
import skein.policy.{Agent, Fleet}
import skein.rpc.RpcError
import skein.units.*

/** Brings a scenario's vehicles to their starts: at rest, hovering, under api control. Altitudes of a scenario are above
  * the place where each vehicle's own frame has its origin.
  *
  * @param calledOff
  *   why vehicles that fly to their starts go no further
  */
final class Preparation(
    client: AirSimClient,
    clock: Clock,
    calledOff: () => Option[String] = () => None
)(using
    system: ActorSystem
):
  import StartPositioning.NotReady
  import Preparation.*
  import system.dispatcher

  /** Lets the vehicles hover there at once, which the built-in simulator alone can do. */
  def place(fleet: Fleet): Future[Either[String, Vector[Multirotor]]] = prepared:
    everyVehicle(fleet): (vehicle, agent) =>
      for
        _ <- call(vehicle.enableApiControl())
        _ <- call(vehicle.arm())
        _ <- call(vehicle.hoverAt(VehiclePose(agent.startPositionNed, Quaternion.Identity)))
      yield vehicle

  /** Flies there by [[StartPositioning]]. For any simulator, in whatever state it is found: what a vehicle has is not taken again,
    * since a vehicle that flies in AirSim falls if api control is taken anew. Those on the ground take off.
    */
  def climb(fleet: Fleet): Future[Either[String, Vector[Multirotor]]] = prepared:
    for
      paused   <- call(client.isPaused())
      _        <- if paused then call(client.resume()) else Future.unit
      vehicles <- everyVehicle(fleet)((vehicle, agent) => Future.successful((vehicle, agent)))
      _        <- StartPositioning.fly(vehicles.map((vehicle, agent) =>
        StartPositioning.Starting(
          agent.startPositionNed + Vector3(0, 0, vehicle.originNed.z),
          Approach(agent.name, AirSimVehicle(vehicle, _ => ()), clock, calledOff),
          () => leaveGround(vehicle)
        )
      ))
    yield vehicles.map(_._1)

  private def leaveGround(vehicle: Multirotor): Future[Vector3] =
    for
      status     <- call(vehicle.status()).map(_.value)
      controlled <- call(vehicle.isApiControlEnabled())
      _          <- if controlled then Future.unit else call(vehicle.enableApiControl())
      // AirSim's landed state is no flight's while a vehicle falls, so it has to be still, too.
      stands = !status.flying && status.kinematics.velocityNed.norm <= StillMps
      _ <- if status.flying then Future.unit else call(vehicle.arm())
      // AirSim stops short of the take-off height and answers false; the position is what counts.
      _     <- if stands then call(vehicle.takeoff()) else Future.unit
      above <- call(vehicle.kinematics()).map(_.value.positionNed)
    yield above

  private def everyVehicle[A](fleet: Fleet)(use: (Multirotor, Agent) => Future[A]): Future[Vector[A]] =
    Future.traverse(fleet.agents): agent =>
      Multirotor
        .named(client, agent.name)
        .flatMap:
          case Left(error)    => Future.failed(NotReady(error.message))
          case Right(vehicle) => use(vehicle, agent)

  private def prepared[A](preparing: => Future[A]): Future[Either[String, A]] =
    preparing.map(Right(_)).recover { case NotReady(reason) => Left(reason) }

  private def call[A](answer: Future[Either[RpcError, A]]): Future[A] = answer.map:
    case Right(value) => value
    case Left(error)  => throw NotReady(AirSimError.Call(error).message)

object Preparation:
  /** What AirSim still takes for no speed, m/s. */
  private val StillMps = 0.05
