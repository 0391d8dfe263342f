package skein.flight

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import skein.airsim.*
import skein.link.Address
import skein.policy.{Agent, Fleet}
import skein.rpc.RpcError
import skein.units.*
import skein.vehicle.CarControls

/** Brings a scenario's vehicles to their starts: at rest, hovering, under api control. A scenario's altitudes
  * are above the origin of each vehicle's own frame.
  *
  * @param calledOff why vehicles must no longer move to their starts
  * @param byTruth whether the vehicles' readings have errors, so that the ground truth decides where they are
  */
final class Preparation(
    client: AirSimClient,
    clock: Clock,
    calledOff: () => Option[String] = () => None,
    byTruth: Boolean = false
)(using
    system: ActorSystem
):
  import Preparation.*
  import system.dispatcher

  /** Places the vehicles hovering at their starts, which only the built-in simulator supports. */
  def place(fleet: Fleet): Future[Either[String, Vector[VehicleClient]]] = prepared:
    everyVehicle(fleet): (vehicle, agent) =>
      vehicle match
        case car: Car               => park(car, agent)
        case multirotor: Multirotor =>
          for
            _ <- call(multirotor.enableApiControl())
            _ <- call(multirotor.arm())
            _ <- call(multirotor.hoverAt(VehiclePose(agent.startPositionNed, Quaternion.Identity)))
          yield vehicle

  /** Flies to the starts by [[StartPositioning]]; cars brake and are placed there. Works in any simulator, in
    * any state: API control that a vehicle already has is not requested again, since a flying vehicle falls
    * in AirSim if it is. Vehicles on the ground take off.
    *
    * @param at the simulator's address
    * @param commands selects the vehicles that fly there, by name; all are returned
    */
  def climb(
      fleet: Fleet,
      at: Address,
      commands: String => Boolean = _ => true
  ): Future[Either[String, Vector[VehicleClient]]] = prepared:
    for
      paused <- CannotFly.unless(client.isPaused())(AirSimError.ofFirst(_, at))
      _      <- if paused then call(client.resume()) else Future.unit
      all    <- everyVehicle(fleet)((vehicle, agent) => Future.successful((vehicle, agent)))
      vehicles = all.filter((_, agent) => commands(agent.name))
      flying   = all.collect { case (multirotor: Multirotor, agent) => (multirotor, agent) }
      _ <- Future.traverse(vehicles.collect { case (car: Car, agent) => (car, agent) })(park)
      _ <- StartPositioning
        .fly(
          flying.map: (multirotor, agent) =>
            StartPositioning.Starting(
              agent.startPositionNed + Vector3(0, 0, multirotor.originNed.z),
              Approach(
                agent.name,
                AirSimVehicle(multirotor, _ => ()),
                clock,
                calledOff,
                Option.when(byTruth)(() => call(multirotor.groundTruth()))
              ),
              () => leaveGround(multirotor)
            ),
          index => commands(flying(index)._2.name)
        )
        .recoverWith:
          case failed: CannotFly =>
            taken(vehicles.map(_._1), at).map(why => throw why.fold(failed)(CannotFly(_)))
    yield all.map(_._1)

  /** Why the first vehicle without API control has lost it, if there is one. */
  private def taken(vehicles: Vector[VehicleClient], at: Address): Future[Option[String]] =
    Future
      .traverse(vehicles)(vehicle => vehicle.isApiControlEnabled().map(vehicle.name -> _))
      .map(_.collectFirst { case (name, Right(false)) => s"the simulator at $at ${Custody.lost(name)}" })

  /** Takes control of the car, brakes it and places it at its start: a car cannot drive there on every route.
    */
  private def park(car: Car, agent: Agent): Future[VehicleClient] =
    def stand(looks: Int): Future[Unit] = call(car.status()).flatMap: status =>
      if math.abs(status.value.speed.value) <= StillMps then Future.unit
      else if looks == 0 then Future.failed(CannotFly(s"'${car.name}' does not come to a stand"))
      else after(Every.toDuration)(stand(looks - 1))
    for
      _ <- call(car.enableApiControl())
      _ <- call(car.setControls(CarControls.Stop))
      _ <- stand(Looks)
      start = agent.startPositionNed.copy(z = car.originNed.z)
      _ <- call(car.setPose(VehiclePose(start, Quaternion.ofYaw(agent.startHeading.value))))
    yield car

  private def leaveGround(vehicle: Multirotor): Future[Vector3] =
    def motion() = if byTruth then call(vehicle.groundTruth()) else call(vehicle.kinematics()).map(_.value)
    for
      status     <- call(vehicle.status()).map(_.value)
      now        <- if byTruth then motion() else Future.successful(status.kinematics)
      controlled <- call(vehicle.isApiControlEnabled())
      _          <- if controlled then Future.unit else call(vehicle.enableApiControl())
      // AirSim's landed state is no flight's while a vehicle falls, so it has to be still, too.
      stands = !status.flying && now.velocityNed.norm <= StillMps
      _ <- if status.flying then Future.unit else call(vehicle.arm())
      // AirSim stops short of the take-off height and answers false; the position is what counts.
      _     <- if stands then call(vehicle.takeoff()) else Future.unit
      above <- motion()
    yield above.positionNed

  private def everyVehicle[A](fleet: Fleet)(use: (VehicleClient, Agent) => Future[A]): Future[Vector[A]] =
    Future.traverse(fleet.agents): agent =>
      CannotFly.unless(Vehicles.named(client, agent.name, agent.kind))(_.message).flatMap(use(_, agent))

  private def prepared[A](preparing: => Future[A]): Future[Either[String, A]] =
    preparing.map(Right(_)).recover { case CannotFly(reason) => Left(reason) }

  private def call[A](answer: Future[Either[RpcError, A]]): Future[A] =
    CannotFly.unless(answer)(_.message)

object Preparation:
  /** Speed below which AirSim's car counts as standing, m/s. */
  private val StillMps = 0.05

  /** Interval of the checks whether a car stands, and their number. */
  private val Every = Span.ofMillis(100)
  private val Looks = 200
