package skein.experiment

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Success
import skein.airsim.*
import skein.airsim.simulator.{SimulatorServer, SimulatorSettings}
import skein.flow.{PlanWorkers, ThreadedPlanWorkers}
import skein.link.*
import skein.loop.*
import skein.policy.Scenario
import skein.record.{Flight as FlightRow, *}
import skein.rpc.{RpcClient, RpcEvent, RpcSettings}
import skein.signal.LatencyProfile
import skein.units.*

/** One flight put together: simulator, link, client, vehicles at their starts, loop. */
final class FlightRig private[experiment] (
    val plan: FlightPlan,
    val flight: Flight,
    watch: Watch,
    startedAt: Instant,
    clock: Clock,
    shutDown: () => Future[Done]
)(using ExecutionContext):

  /** How far it is, in the controller's time. */
  def progress: Progress = Progress(plan.id, clock.now().since(startedAt), watch.sight)

  /** Completes when the flight has ended, everything is closed, and all that was recorded is written. */
  val landed: Future[Landed] =
    for
      outcome <- flight.outcome
      closed  <- shutDown().transform(Success(_))
      written <- watch.close()
    yield
      val notClosed = closed.failed.toOption.map(error => Outcome.Failed(s"it could not be closed: $error"))
      Landed(plan, notClosed.filter(_ => outcome == Outcome.Completed).getOrElse(outcome), written)

/** How a flight ended, and what is on record. */
final case class Landed(plan: FlightPlan, outcome: Outcome, written: Either[RecordError, Written])

/** Puts flights together.
  *
  * @param simulator
  *   the address of a simulator that runs already; without one, each flight has a built-in simulator of its own
  * @param workers
  *   what a flight that plans searches with
  */
final class FlightRigs(
    transport: Transport,
    clock: Clock,
    settings: FlySettings,
    simulator: Option[Address],
    workers: PlanSettings => PlanWorkers = FlightRigs.threads
)(using system: ActorSystem):
  import system.dispatcher

  /** Vehicles, starts and roles, alike in all flights; the policies are the plan's. */
  private val scenario: Scenario = settings.agents

  /** What a recording of this flight begins with. */
  def heading(plan: FlightPlan, clockKind: String): Heading = Heading(
    FlightRow(
      plan.id,
      plan.loop.label,
      plan.link.name,
      plan.seed,
      settings.period,
      settings.duration,
      clockKind,
      simulator.fold("built-in")(_.toString),
      settings.scenario + (if settings.asPublished then ", as published" else "") +
        plan.policy.fold("")(chosen => s", ${PolicyFile.name(chosen.file.role)} ${chosen.file.label}"),
      FlightRigs.version,
      clock.now()
    ),
    scenario.agents.map(agent =>
      Vehicle(agent.name, agent.role.toString, agent.speed, agent.startPositionNed)
    ),
    RecordedPlan.parameters(settings, plan)
  )

  /** Prepares and starts a flight. What was opened for a flight that cannot start is closed again.
    *
    * @return
    *   or why it cannot be flown
    */
  def start(plan: FlightPlan, recorder: Recorder): Future[Either[String, FlightRig]] =
    val opened   = Opened()
    val starting =
      for
        server <- serve()
        address = server.fold(simulator.get)(opened.closing(_)(_.close()).address)
        ready <- prepare(address)
        proxy <- between(plan, address)
        watch  = Watch(recorder)
        client = opened.closing(
          fly(plan, proxy.fold(address)(opened.closing(_)(_.close()).address), watch)
        )(_.close())
        crafts = ready.zipWithIndex.map((vehicle, index) =>
          MultirotorCraft(
            Multirotor(client, vehicle.name, vehicle.originNed, index),
            lost => watch.offer(Event(clock.now(), EventKind.TimedOut, Some(vehicle.name), lost))
          )
        )
        _ <- client.ping()
      yield
        val loopSettings = settings.loopSettings.copy(seed = plan.seed)
        val planners     =
          if plan.loop != LoopKind.Plan then PlanWorkers.none
          else
            opened.closing(workers(settings.planningByModel)): threads =>
              threads.close()
              Future.successful(Done)
        val team      = Team(plan.agents(settings), crafts, clock, watch, loopSettings, planners)
        val startedAt = clock.now()
        val flight    =
          Flight.start(plan.loop, team, AirSimStepper(client), settings.duration, clock, watch)
        Right(FlightRig(plan, flight, watch, startedAt, clock, () => opened.close()))
    starting
      .recoverWith { case error => opened.close().transformWith(_ => Future.failed(error)) }
      .recover { case error: (TransportError | CannotFly) => Left(error.getMessage) }

  private def serve(): Future[Option[SimulatorServer]] =
    if simulator.isDefined then Future.successful(None)
    else
      val vehicles = scenario.agents.map(agent =>
        VehicleSettings(agent.name, agent.startPositionNed.copy(z = 0), agent.startHeading)
      )
      SimulatorServer
        .start(
          SimulatorSettings(
            WorldSettings(vehicles, text = WorldSettings.render(vehicles)),
            FlightRigs.anyPort
          ),
          transport,
          clock
        )
        .map(Some(_))

  /** Over a connection of its own, without the link: this is not part of the flight. */
  private def prepare(address: Address): Future[Vector[Multirotor]] =
    val client      = AirSimClient(RpcClient(transport, address, clock))
    val preparation = Preparation(client)
    val prepared    = if simulator.isDefined then preparation.climb(scenario) else preparation.place(scenario)
    prepared
      .flatMap(result => client.close().map(_ => result))
      .map(_.fold(error => throw CannotFly(error.message), identity))

  /** The emulated link, if the flight is to have one. */
  private def between(plan: FlightPlan, simulator: Address): Future[Option[LinkProxy]] =
    if plan.link == LatencyProfile.none then Future.successful(None)
    else
      val link = EmulatedLink(LinkProfile.symmetric(plan.link), plan.seed, clock)
      LinkProxy.start(FlightRigs.anyPort, simulator, link, transport).map(Some(_))

  private def fly(plan: FlightPlan, address: Address, recorder: Recorder): AirSimClient =
    val rpc = RpcClient(
      transport,
      address,
      clock,
      FlightRigs.rpcSettings(plan.loop),
      plan.seed,
      event =>
        FlightRigs.eventOf(event).foreach((kind, detail) =>
          recorder.offer(Event(clock.now(), kind, None, detail))
        )
    )
    AirSimClient(rpc, timeout = FlightRigs.askTimeout)

  private case class CannotFly(reason: String) extends RuntimeException(reason)

object FlightRigs:
  /** The paper's, of every question. */
  val askTimeout: Span = Span.ofMillis(500)

  /** Of the client that flies a loop. */
  def rpcSettings(loop: LoopKind): RpcSettings = loop match
    // Each command must reach the simulator before the step that follows it: one ordered connection.
    case LoopKind.Paused => RpcSettings(controlConnections = 1)
    case _               => RpcSettings()

  /** Threads to plan on, no more than there are cores. */
  private def threads(planning: PlanSettings): PlanWorkers =
    new ThreadedPlanWorkers(planning.searches.min(Runtime.getRuntime.availableProcessors))

  private val anyPort = Address("127.0.0.1", 0)

  private val version = Option(getClass.getPackage.getImplementationVersion).getOrElse("development")

  /** What of the client's events a recording keeps; failed calls are recorded by whoever called. */
  private def eventOf(event: RpcEvent): Option[(EventKind, String)] = event match
    case RpcEvent.Disconnected(lane, connection, reason) =>
      Some(EventKind.Disconnected -> s"$lane connection $connection: $reason")
    case RpcEvent.ConnectFailed(lane, connection, reason) =>
      Some(EventKind.Disconnected -> s"$lane connection $connection: $reason")
    case RpcEvent.LateReply(method, _, _, after) =>
      Some(EventKind.LateReply -> f"$method answered after ${after.toMillis}%.0f ms")
    case _ => None
