package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.airsim.*
import skein.policy.{Agent, Fleet}
import skein.rpc.RpcError
import skein.units.*

/** Brings a scenario's vehicles to their starts: at rest, hovering, under api control. Altitudes of a scenario are above
  * the place where each vehicle's own frame has its origin.
  */
final class Preparation(client: AirSimClient, clock: Clock)(using system: ActorSystem):
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

  /** Flies there, all vehicles at once, and waits until all are at rest and look north. For any simulator, in whatever
    * state it is found: what a vehicle has is not taken again, since a vehicle that flies in AirSim falls if api control is
    * taken anew. Those on the ground take off; those in the air, wherever the flight before has left them, first climb
    * straight to a layer of their own, above all starts, and cross over in it when all have come to theirs; when all have
    * crossed over, they go down. So no way crosses another at one altitude.
    */
  def climb(fleet: Fleet): Future[Either[String, Vector[Multirotor]]] = prepared:
    for
      paused   <- call(client.isPaused())
      _        <- if paused then call(client.resume()) else Future.unit
      vehicles <- everyVehicle(fleet)((vehicle, agent) =>
        Future.successful(
          Starting(
            vehicle,
            agent.startPositionNed + Vector3(0, 0, vehicle.originNed.z),
            Approach(agent.name, AirSimVehicle(vehicle, _ => ()), clock)
          )
        )
      )
      highest = vehicles.map(_.startNed.z).min
      layers  = vehicles.indices.map(index => highest - (index + 1) * LayerM)
      _ <- Future.traverse(vehicles.zip(layers))(offTheGround)
      _ <- Future.traverse(vehicles.zip(layers))(across)
      _ <- Future.traverse(vehicles)(one => go(one, one.startNed, Approach.AtRest))
    yield vehicles.map(_.vehicle)

  private def offTheGround(one: Starting, layerDownM: Double): Future[Unit] =
    val vehicle = one.vehicle
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
      _     <- go(one, above.copy(z = layerDownM), Approach.Passing)
    yield ()

  /** For those that are in their layer. */
  private def across(one: Starting, layerDownM: Double): Future[Unit] =
    go(one, one.startNed.copy(z = layerDownM), Approach.Passing)

  private def go(one: Starting, goalNed: Vector3, limits: Approach.Limits): Future[Unit] =
    one.approach.to(goalNed, limits).map(_.fold(reason => throw NotReady(reason), _ => ()))

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

  /** Carries an expected error out of a chain of calls. */
  private case class NotReady(reason: String) extends RuntimeException(reason)

object Preparation:
  /** A vehicle on its way to its start, world NED. */
  private final case class Starting(vehicle: Multirotor, startNed: Vector3, approach: Approach)

  /** From one vehicle's layer to the next, m: more than a vehicle passes its goal by. */
  private val LayerM = 5.0

  /** What AirSim still takes for no speed, m/s. */
  private val StillMps = 0.05
