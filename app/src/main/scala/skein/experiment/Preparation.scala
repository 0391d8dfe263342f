package skein.experiment

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.airsim.*
import skein.policy.{Agent, Scenario}
import skein.signal.Kinematics
import skein.units.*

/** Brings a scenario's vehicles to their starts: at rest, hovering, under api control. */
final class Preparation(client: AirSimClient)(using system: ActorSystem):
  import Preparation.*
  import system.dispatcher

  /** Puts the vehicles there at once. For the built-in simulator, which lets an armed vehicle hover where it is put. */
  def place(scenario: Scenario): Future[Either[AirSimError, Vector[Multirotor]]] =
    everyVehicle(scenario): (vehicle, agent) =>
      ready(vehicle).flatMap(_ =>
        call(vehicle.setPose(VehiclePose(agent.startPositionNed, Quaternion.Identity)))
      )

  /** Flies there, all vehicles at once, and waits until all are at rest. For any simulator. Those on the ground take
    * off; those in the air, wherever the flight before has left them, first climb straight to a layer of their own, above
    * all starts, and cross over in it when all have come to theirs; when all have crossed over, they go down. So no way
    * crosses another at one altitude.
    */
  def climb(scenario: Scenario): Future[Either[AirSimError, Vector[Multirotor]]] =
    val highest = scenario.agents.map(_.startPositionNed.z).min
    val layers  =
      scenario.agents.zipWithIndex.map((agent, i) => agent.name -> (highest - (i + 1) * LayerM)).toMap
    val phases = Seq[(Multirotor, Agent) => Future[Unit]](
      (vehicle, agent) => ready(vehicle).flatMap(_ => offTheGround(vehicle, layers(agent.name))),
      (vehicle, agent) => across(vehicle, agent.startPositionNed.copy(z = layers(agent.name))),
      (vehicle, agent) => arrive(vehicle, agent, CruiseSpeed, Approaches)
    )
    phases.tail.foldLeft(everyVehicle(scenario)(phases.head)): (before, phase) =>
      before.flatMap:
        case Left(error) => Future.successful(Left(error))
        case Right(_)    => everyVehicle(scenario)(phase)

  private def offTheGround(vehicle: Multirotor, layerDownM: Double): Future[Unit] =
    call(vehicle.status()).flatMap: status =>
      if status.value.flying then
        goTo(vehicle, status.value.kinematics.positionNed.copy(z = layerDownM), CruiseSpeed).map(_ => ())
      // AirSim stops short of the take-off height and answers false; the position is what counts.
      else call(vehicle.takeoff()).map(_ => ())

  /** For those that are in their layer. */
  private def across(vehicle: Multirotor, goalNed: Vector3): Future[Unit] =
    call(vehicle.kinematics()).flatMap: reading =>
      if math.abs(reading.value.positionNed.z - goalNed.z) > LayerM then Future.unit
      else goTo(vehicle, goalNed, CruiseSpeed).map(_ => ())

  /** AirSim's moves end in passing their goal, the further off the faster they were: so again, slowly, from rest. */
  private def arrive(
      vehicle: Multirotor,
      agent: Agent,
      speed: MetresPerSecond,
      approaches: Int
  ): Future[Unit] =
    goTo(vehicle, agent.startPositionNed, speed).flatMap: rest =>
      val off = (rest.positionNed - agent.startPositionNed).norm
      if rest.velocityNed.norm <= RestMps && off <= StartM then Future.unit
      else if approaches > 1 then arrive(vehicle, agent, ApproachSpeed, approaches - 1)
      else Future.failed(NotReady(AirSimError.NotAtStart(agent.name, off, rest.velocityNed.norm)))

  /** Where it comes to rest. */
  private def goTo(vehicle: Multirotor, goalNed: Vector3, speed: MetresPerSecond): Future[Kinematics] =
    for
      _    <- call(vehicle.moveToPosition(goalNed, speed))
      _    <- call(vehicle.hover())
      rest <- comingToRest(vehicle, SettlingPolls)
    yield rest

  /** How it is once it is at rest, or after so many looks more. */
  private def comingToRest(vehicle: Multirotor, polls: Int): Future[Kinematics] =
    call(vehicle.kinematics()).flatMap: reading =>
      if polls == 0 || reading.value.velocityNed.norm <= RestMps then Future.successful(reading.value)
      else pattern.after(PollEvery)(comingToRest(vehicle, polls - 1))

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
  private val CruiseSpeed   = MetresPerSecond(5)
  private val ApproachSpeed = MetresPerSecond(1)

  /** From one vehicle's layer to the next, m: more than a vehicle passes its goal by. */
  private val LayerM = 5.0

  /** What AirSim still takes for no speed, m/s. */
  private val RestMps = 0.05

  /** AirSim's slow moves end half a metre before or behind their goal. */
  private val StartM = 0.75

  private val Approaches    = 5
  private val PollEvery     = 100.millis
  private val SettlingPolls = 200
