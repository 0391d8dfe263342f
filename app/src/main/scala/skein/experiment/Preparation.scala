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
    * off; those in the air, wherever the flight before has left them, change over each in a layer of its own, above all
    * starts, so that no way crosses another at one altitude.
    */
  def climb(scenario: Scenario): Future[Either[AirSimError, Vector[Multirotor]]] =
    val highest = scenario.agents.map(_.startPositionNed.z).min
    val layers  =
      scenario.agents.zipWithIndex.map((agent, i) => agent.name -> (highest - (i + 1) * LayerM)).toMap
    everyVehicle(scenario): (vehicle, agent) =>
      for
        _      <- ready(vehicle)
        status <- call(vehicle.status())
        _      <-
          if status.value.flying then
            changeOver(vehicle, status.value.kinematics.positionNed, agent, layers(agent.name))
          // AirSim stops short of the take-off height and answers false; the position is what counts.
          else call(vehicle.takeoff())
        _ <- arrive(vehicle, agent, CruiseSpeed, Approaches)
      yield ()

  private def changeOver(
      vehicle: Multirotor,
      fromNed: Vector3,
      agent: Agent,
      layerDownM: Double
  ): Future[Unit] =
    for
      _ <- call(vehicle.moveToPosition(fromNed.copy(z = layerDownM), CruiseSpeed))
      _ <- call(vehicle.moveToPosition(agent.startPositionNed.copy(z = layerDownM), CruiseSpeed))
    yield ()

  /** AirSim's moves end in passing their goal, the further off the faster they were: so again, slowly, from rest. */
  private def arrive(
      vehicle: Multirotor,
      agent: Agent,
      speed: MetresPerSecond,
      approaches: Int
  ): Future[Unit] =
    for
      _    <- call(vehicle.moveToPosition(agent.startPositionNed, speed))
      _    <- call(vehicle.hover())
      rest <- comingToRest(vehicle, SettlingPolls)
      off = (rest.positionNed - agent.startPositionNed).norm
      _ <-
        if rest.velocityNed.norm <= RestMps && off <= StartM then Future.unit
        else if approaches > 1 then arrive(vehicle, agent, ApproachSpeed, approaches - 1)
        else Future.failed(NotReady(AirSimError.NotAtStart(agent.name, off, rest.velocityNed.norm)))
    yield ()

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

  /** From one vehicle's layer to the next. */
  private val LayerM = 3.0

  /** What AirSim still takes for no speed, m/s. */
  private val RestMps = 0.05

  /** AirSim's slow moves end half a metre before or behind their goal. */
  private val StartM = 0.75

  private val Approaches    = 5
  private val PollEvery     = 100.millis
  private val SettlingPolls = 200
