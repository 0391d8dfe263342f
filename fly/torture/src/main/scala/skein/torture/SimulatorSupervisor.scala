package skein.torture

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import skein.airsim.*
import skein.flight.Preparation
import skein.link.*
import skein.policy.Fleet
import skein.rpc.RpcClient
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.units.*

/** One run of the simulator, until the next.
  *
  * @param from when it had started, on the controller's clock
  * @param clockOffset the controller's clock minus the simulator's during the run
  */
final case class Run(from: Instant, clockOffset: Span)

/** Runs the simulator, restarts it according to the [[FaultPlan]], and then brings the vehicles to their
  * starts again. It uses a separate connection without faults.
  */
final class SimulatorSupervisor(
    scenario: Fleet,
    settings: SimulatorSettings,
    simulatorHost: Transport,
    ownHost: Transport,
    clock: Clock
)(using system: ActorSystem):
  import system.dispatcher

  private var server = Option.empty[SimulatorServer]
  private var ran    = Vector.empty[Run]

  /** The runs of the simulator so far, with their clocks. */
  def runs: Vector[Run] = ran

  /** Starts the simulator, its clock off by `clockJump`, and prepares the vehicles. */
  def start(clockJump: Span): Future[Vector[VehicleClient]] =
    val itsClock: Clock = Clock.ofNanos(() => (clock.now() + clockJump).toNanos)
    for
      started <- SimulatorServer.start(settings, simulatorHost, itsClock)
      _ = server = Some(started)
      _ = ran :+= Run(clock.now(), Span.Zero - clockJump)
      prepared <- asking(client => Preparation(client, clock).place(scenario))
    yield prepared.fold(reason => throw IllegalStateException(reason), identity)

  def restart(restart: Restart): Future[Done] =
    for
      _ <- stop()
      _ <- after(restart.lasts.toDuration, system.scheduler)(Future.unit)
      _ <- start(restart.clockJump)
    yield Done

  def positions(vehicles: Vector[VehicleClient]): Future[Vector[Vector3]] =
    asking: client =>
      Future.sequence:
        vehicles.map: vehicle =>
          vehicle.over(client)
            .groundTruth()
            .map(_.fold(error => throw IllegalStateException(error.message), _.positionNed))

  def isPaused(): Future[Boolean] =
    asking(_.isPaused().map(_.fold(error => throw IllegalStateException(error.message), identity)))

  def stop(): Future[Done] = server.fold(Future.successful(Done))(_.close())

  private def asking[A](question: AirSimClient => Future[A]): Future[A] =
    val client = AirSimClient(RpcClient(ownHost, settings.address, clock))
    question(client).flatMap(answer => client.close().map(_ => answer))
