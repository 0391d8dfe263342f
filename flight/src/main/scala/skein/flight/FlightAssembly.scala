package skein.flight

import java.util.concurrent.Executors
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.Flow
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Success
import skein.airsim.*
import skein.flow.Hold
import skein.link.*
import skein.loop.*
import skein.loop.learning.{Learning, Lessons, LessonsAgain, LessonsBeside}
import skein.loop.planning.{BackgroundThread, PlanWorkers, ThreadedPlanWorkers}
import skein.policy.Fleet
import skein.port.{SteppedTime, VehiclePort}
import skein.record.{Flight as FlightRow, *}
import skein.rpc.{RpcClient, RpcEvent, RpcSettings}
import skein.settings.{ChosenPolicy, FlightPlan, FlySettings, PolicyFile, RecordedPlan, Wire}
import skein.signal.LatencyProfile
import skein.solver.{Briefing, SolverClient}
import skein.simulator.{MavlinkSettings, SimulatorServer, SimulatorSettings}
import skein.units.*
import skein.units.Decimals.fixed

/** One flight put together: simulator, link, client, vehicles at their starts, loop. */
final class FlightAssembly private[skein] (
    val plan: FlightPlan,
    val flight: Flight,
    val graph: RunningGraph,
    hold: Hold,
    monitor: FlightMonitor,
    watchdog: SimulatorWatchdog,
    startedAt: Instant,
    clock: Clock,
    shutDown: () => Future[Done],
    solver: Option[SolverClient]
)(using ExecutionContext):

  /** Ends it now; why is recorded. */
  def stop(why: String): Unit =
    monitor.offer(Event(clock.now(), EventKind.Aborted, None, why))
    flight.stop()

  /** Its vehicles hover and nobody decides, until it continues or ends; its time runs on. Who did it is recorded. */
  def pause(who: String): Unit =
    if hold.hold() then monitor.offer(Event(clock.now(), EventKind.Paused, None, who))

  /** Lets it go on where it is paused. Who did it is recorded. */
  def continue(who: String): Unit =
    if hold.isHeld then
      // Before the first decision that it lets be made.
      monitor.offer(Event(clock.now(), EventKind.Continued, None, who))
      hold.release(): Unit

  /** How far it is, in the controller's time. */
  def progress: Progress =
    val now = clock.now()
    Progress(plan.id, now.since(startedAt), monitor.lastSeen(now), watchdog.silentFor)

  /** Completes when the flight has ended, everything is closed, and all that was recorded is written. */
  val landed: Future[FlightResult] =
    for
      outcome <- flight.outcome
      closed  <- shutDown().transform(Success(_))
      notClosed = closed.failed.toOption.map(error => Outcome.Failed(s"it could not be closed: $error"))
      ended     = notClosed.filter(_ => outcome == Outcome.Completed).getOrElse(outcome)
      _         = monitor.offer(FlightAssembly.ending(ended, clock.now()))
      written <- monitor.close()
    yield FlightResult(plan, ended, written, solver.fold(Vector.empty)(_.roundTrips))

private object FlightAssembly:
  def ending(outcome: Outcome, at: Instant): Ending = outcome match
    case Outcome.Completed      => Ending(at, EndingKind.Completed, None)
    case Outcome.Stopped        => Ending(at, EndingKind.Stopped, Some("it was stopped from outside"))
    case Outcome.Failed(reason) => Ending(at, EndingKind.Failed, Some(reason))

/** How a flight ended, and what is on record.
  *
  * @param solverTrips
  *   the latest round trips to the solver, if one decided
  */
final case class FlightResult(
    plan: FlightPlan,
    outcome: Outcome,
    written: Either[RecordError, Written],
    solverTrips: Vector[Span] = Vector.empty
)

/** Puts flights together.
  *
  * @param simulator
  *   the address of a simulator that runs already; without one, each flight has a built-in simulator of its own
  * @param workers
  *   what a flight that plans searches with
  * @param tell
  *   a line for a person, of what goes wrong in flight, as soon as it does
  * @param learnsOn
  *   what policies learn on that learn in flight; without it, each on a thread of its own that gives way to all others
  * @param solvers
  *   the links to solvers, for flights that are not decided for here
  * @param calledOff
  *   why a flight, by its name, goes no further while its vehicles are brought to their starts
  * @param isWatched
  *   whether its records are shown, so that images and clouds are offered that are not recorded
  */
final class FlightAssembler(
    transport: Transport,
    clock: Clock,
    settings: FlySettings,
    simulator: Option[Address],
    workers: PlanSettings => PlanWorkers = FlightAssembler.threads,
    tell: String => Unit = _ => (),
    learnsOn: Option[ExecutionContext] = None,
    calledOff: String => Option[String] = _ => None,
    solvers: Solvers = Solvers.none,
    isWatched: Boolean = false
)(using system: ActorSystem):
  import system.dispatcher

  private val recorded: Set[ImagingSensor] = settings.recordedImaging

  /** Whether a record is kept, and not only shown. */
  private[flight] def keeps(record: Record): Boolean = ImagingSensor.of(record).forall(recorded)

  /** Vehicles, starts and roles, alike in all flights; the policies are the plan's. */
  private val fleet: Fleet = settings.fleet

  /** What a recording of this flight begins with. */
  def heading(plan: FlightPlan, clockKind: String): RecordingHeader = RecordingHeader(
    FlightRow(
      plan.id,
      plan.loop.label,
      plan.link.name,
      plan.seed,
      settings.period,
      settings.duration,
      clockKind,
      simulator.fold("built-in")(_.toString) + (if settings.wire == Wire.Mavlink then ", MAVLink" else ""),
      settings.scenario.title +
        plan.policy.fold("")(chosen => s", ${PolicyFile.name(chosen.file.role)} ${chosen.file.label}"),
      FlightAssembler.version,
      clock.now()
    ),
    fleet.agents.map(Vehicle.of),
    RecordedPlan.parameters(settings, plan)
  )

  /** Prepares and starts a flight. What was opened for a flight that cannot start is closed again.
    *
    * @return
    *   or why it cannot be flown
    */
  def start(plan: FlightPlan, recorder: Recorder): Future[Either[String, FlightAssembly]] =
    val opened   = Opened()
    val starting =
      for
        server <- serve()
        _       = server.foreach(opened.closing(_)(_.close()))
        monitor = FlightMonitor(recorder)
        solver  <- solverOf(plan, opened, monitor)
        reached <- settings.wire match
          case Wire.AirSim  => overAirSim(plan, server.fold(simulator.get)(_.address), opened, monitor)
          case Wire.Mavlink => overMavlink(plan, server, opened)
        _ <- Team.missingSensor(fleet, reached.crafts).fold(reached.ping())(missing =>
          Future.failed(CannotFly(missing))
        )
      yield
        val loopSettings = settings.loopSettings(plan)
        val planners     =
          if plan.loop != LoopKind.Plan then PlanWorkers.none
          else
            opened.closing(workers(settings.planningByModel)): threads =>
              threads.close()
              Future.successful(Done)
        val endCondition = EndCondition(settings.scenario, plan.loop == LoopKind.Paused, monitor)
        val flown        = plan.policy.fold(plan.fleet(settings))(learning(plan, _, opened, monitor))
        val team         = Team(flown, reached.crafts, clock, endCondition, loopSettings, planners, solver)
        val startedAt    = clock.now()
        val watchdog     = SimulatorWatchdog(
          monitor,
          clock,
          startedAt,
          SimulatorWatchdog.within(settings.period, FlightAssembler.askTimeout),
          reached.where,
          reached.isOther,
          () => team.underDecision,
          line => tell(s"${plan.id}: $line")
        )
        val flight = Flight.start(
          plan.loop,
          team,
          reached.time,
          settings.duration,
          clock,
          endCondition,
          () => watchdog.onTime
        )
        endCondition.isOver.foreach(_ => flight.complete())
        if plan.loop != LoopKind.Paused then
          for one <- reached.cameras do
            opened.closing(one)(_.close()): Unit
            one.run()
          for one <- reached.films do
            opened.closing(one)(_.close()): Unit
            one.run()
        watchdog.over(flight)
        Right(FlightAssembly(
          plan,
          flight,
          RunningGraph(team.meters),
          team.hold,
          monitor,
          watchdog,
          startedAt,
          clock,
          () => opened.close(),
          solver
        ))
    starting
      .recoverWith { case error => opened.close().transformWith(_ => Future.failed(error)) }
      .recover { case error: (TransportError | CannotFly | SolverClient.NoSolver) => Left(error.getMessage) }

  /** Who decides in this process' place, when it has welcomed the flight. */
  private def solverOf(
      plan: FlightPlan,
      opened: Opened,
      monitor: FlightMonitor
  ): Future[Option[SolverClient]] =
    plan.solver match
      case None         => Future.successful(None)
      case Some(choice) =>
        solvers.link(choice) match
          case Left(reason) => Future.failed(CannotFly(s"--solver ${choice.text}: $reason"))
          case Right(link)  =>
            val agents = fleet.agents
            val client = opened.closing(SolverClient(
              link,
              solvers.number(plan, clock),
              solvers.build,
              Briefing.of(settings, plan),
              agents.size,
              clock,
              (kind, vehicle, detail) =>
                monitor.offer(Event(clock.now(), kind, vehicle.map(agents(_).name), detail))
                if FlightAssembler.told(kind) then tell(s"${plan.id}: $detail")
            ))(_.close())
            client
              .ready(solvers.patience)
              .recoverWith:
                case no: SolverClient.NoSolver =>
                  Future.failed(CannotFly(s"--solver ${choice.text}: ${no.reason}"))
              .map(_ => Some(client))

  /** Who flies, with a policy that may learn. */
  private def learning(
      plan: FlightPlan,
      chosen: ChosenPolicy,
      opened: Opened,
      monitor: FlightMonitor
  ): Fleet =
    def taught(lessons: Lessons, explore: Double) =
      chosen.learningIn(plan.fleet(settings), lessons, explore, plan.seed): (vehicle, decision, news) =>
        RecordedPlan.learned(clock.now(), vehicle, decision, news).foreach(monitor.offer)
    chosen.learning match
      case None                                  => plan.fleet(settings)
      case Some(Learning.Again(explore, news))   => taught(LessonsAgain(news), explore)
      case Some(Learning.Beside(explore, begun)) =>
        val on = learnsOn.getOrElse:
          val thread = Executors.newSingleThreadExecutor(BackgroundThread.factory("skein-learn"))
          // It may hang in a lesson: nobody waits for that.
          opened.closing(ExecutionContext.fromExecutorService(thread)): _ =>
            thread.shutdownNow()
            Future.successful(Done)
        val lessons = opened.closing(LessonsBeside(begun(plan.seed), on)): lessons =>
          lessons.close()
          Future.successful(Done)
        taught(lessons, explore)

  private def overAirSim(
      plan: FlightPlan,
      address: Address,
      opened: Opened,
      monitor: FlightMonitor
  ): Future[Reached] =
    for
      ready <- prepare(plan, address)
      proxy <- between(plan, address)
      client = opened.closing(
        fly(plan, proxy.fold(address)(opened.closing(_)(_.close()).address), monitor)
      )(_.close())
      vehicles = ready.zipWithIndex.map((vehicle, index) =>
        // Altitudes count from where each vehicle starts, as in its own frame.
        vehicle.over(client, vehicle.originNed.copy(z = 0), index)
      )
      logs    = vehicles.map(ImageRecorder(_, monitor, sight => isWatched || recorded(sight)))
      cameras = vehicles.zip(logs).map(look(plan, _, monitor, _))
      films   = vehicles.zip(logs).flatMap(film(_, monitor, _))
      crafts  = vehicles.zip(cameras).zip(logs).map: (looking, log) =>
        val (vehicle, eyes) = looking
        val craft           = Vehicles.port(
          vehicle,
          lost => monitor.offer(Event(clock.now(), EventKind.TimedOut, Some(vehicle.name), lost))
        )
        val isPaused = plan.loop == LoopKind.Paused
        val seen     = eyes.map(one => one.eye.sensor -> (if isPaused then one.looking else one.sensor))
        Equipped.by(settings.scenario, craft, vehicle, seen.toMap, log.scan)
      _ <- if settings.world.isEmpty then Future.unit else watchContacts(opened, address, vehicles, monitor)
    yield Reached(
      crafts,
      Some(AirSimTime(client)),
      address.toString,
      () => client.ping(),
      () => FlightAssembler.startedAgain(vehicles, address),
      cameras.flatten,
      films
    )

  /** By a connection of bytes to a simulator of its own, by datagrams to any other. */
  private def overMavlink(
      plan: FlightPlan,
      server: Option[SimulatorServer],
      opened: Opened
  ): Future[Reached] =
    val at      = server.flatMap(_.peerAddresses.headOption).orElse(simulator).get
    val by      = if server.isDefined then transport else UdpTransport()
    def plain() = by.connect(at)
    def linked: Flow[ByteString, ByteString, ?] =
      if plan.link == LatencyProfile.none then plain()
      else
        EmulatedLink(LinkProfile.symmetric(plan.link), plan.seed, clock)
          .connection(TransportError.Lost(at, "the link broke"))
          .join(plain())
    val origin  = server.map(_ => WorldSettings.DefaultOrigin)
    val mavlink =
      MavlinkFleet(fleet, clock, origin, plain, isDatagrams = server.isEmpty, () => calledOff(plan.id))
    def right[A](answer: Either[String, A]): A = answer.fold(reason => throw CannotFly(reason), identity)
    for
      _ <-
        if plan.loop == LoopKind.Paused then Future.failed(CannotFly(FlightAssembler.noSteps))
        else Future.unit
      _                <- mavlink.prepare().map(right)
      (link, vehicles) <- mavlink.open(linked, isStream = plan.link != LatencyProfile.none).map(right)
    yield
      val _ = opened.closing(link)(_.close())
      Reached(vehicles, None, at.toString, () => Future.unit, () => Future.successful(Right(None)))

  /** @param where
    *   the vehicles are, for a person
    * @param isOther
    *   see [[SimulatorWatchdog]]
    * @param cameras
    *   what recognises in their cameras' images
    * @param films
    *   of their other cameras
    */
  private final case class Reached(
      crafts: Vector[VehiclePort],
      time: Option[SteppedTime],
      where: String,
      ping: () => Future[Any],
      isOther: () => Future[Either[String, Option[String]]],
      cameras: Vector[CameraSensor] = Vector.empty,
      films: Vector[FilmedCamera] = Vector.empty
  )

  private def serve(): Future[Option[SimulatorServer]] =
    if simulator.isDefined then Future.successful(None)
    else
      val vehicles = fleet.agents.map(Vehicles.settings)
      SimulatorServer
        .start(
          SimulatorSettings(
            WorldSettings(vehicles, text = WorldSettings.render(vehicles, settings.scenario.equipment)),
            FlightAssembler.anyPort,
            scene = settings.world.scene,
            mavlink =
              Option.when(settings.wire == Wire.Mavlink)(MavlinkSettings(listen =
                Some(FlightAssembler.anyPort)
              ))
          ),
          transport,
          clock
        )
        .map(Some(_))

  /** What the scenario's eyes make of a vehicle's cameras. */
  private def look(
      plan: FlightPlan,
      vehicle: VehicleClient,
      recorder: Recorder,
      log: ImageRecorder
  ): Vector[CameraSensor] =
    settings.scenario.eyes.filter(_.vehicle == vehicle.name).map: eye =>
      if isWatched || recorded.nonEmpty then log.ask(eye.camera)
      CameraSensor(
        eye,
        vehicle.eyes,
        plan.seed,
        clock,
        (kind, detail) => recorder.offer(Event(clock.now(), kind, Some(vehicle.name), detail)),
        log.image
      )

  /** Its cameras that nobody decides by. */
  private def film(vehicle: VehicleClient, recorder: Recorder, log: ImageRecorder): Vector[FilmedCamera] =
    settings.filmed.filter(_.sight.vehicle == vehicle.name).map: (sight, every) =>
      log.ask(sight.name)
      FilmedCamera(
        sight.name,
        every,
        vehicle.eyes,
        clock,
        log.image,
        (kind, detail) => recorder.offer(Event(clock.now(), kind, Some(vehicle.name), detail))
      )

  private def watchContacts(
      opened: Opened,
      address: Address,
      vehicles: Vector[VehicleClient],
      recorder: Recorder
  ): Future[Unit] =
    ContactWatch
      .start(
        AirSimClient(RpcClient(transport, address, clock), FlightAssembler.askTimeout),
        vehicles,
        settings.period,
        clock,
        recorder
      )
      .map(contacts => opened.closing(contacts)(_.close()): Unit)

  /** Over a connection of its own, without the link: this is not part of the flight. */
  private def prepare(plan: FlightPlan, address: Address): Future[Vector[VehicleClient]] =
    val client      = AirSimClient(RpcClient(transport, address, clock))
    val preparation = Preparation(client, clock, () => calledOff(plan.id))
    val prepared    = if simulator.isDefined then preparation.climb(fleet) else preparation.place(fleet)
    prepared
      .flatMap(result => client.close().map(_ => result))
      .map(_.fold(reason => throw CannotFly(reason), identity))

  /** The emulated link, if the flight is to have one. */
  private def between(plan: FlightPlan, simulator: Address): Future[Option[LinkProxy]] =
    if plan.link == LatencyProfile.none then Future.successful(None)
    else
      val link = EmulatedLink(LinkProfile.symmetric(plan.link), plan.seed, clock)
      LinkProxy.start(FlightAssembler.anyPort, simulator, link, transport).map(Some(_))

  private def fly(plan: FlightPlan, address: Address, recorder: Recorder): AirSimClient =
    val rpc = RpcClient(
      transport,
      address,
      clock,
      FlightAssembler.rpcSettings(plan.loop),
      plan.seed,
      event =>
        FlightAssembler.eventOf(event).foreach((kind, detail) =>
          recorder.offer(Event(clock.now(), kind, None, detail))
        )
    )
    AirSimClient(rpc, timeout = FlightAssembler.askTimeout)

  private case class CannotFly(reason: String) extends RuntimeException(reason)

object FlightAssembler:
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

  /** Whether a simulator has been started again since it let these vehicles be flown: then nobody has api control of
    * them. Its clock need not tell, since AirSim's begins with the time of day.
    *
    * @return
    *   `Left` where it did not answer, else why a flight cannot go on
    */
  private def startedAgain(vehicles: Vector[VehicleClient], simulator: Address)(using
      ExecutionContext
  ): Future[Either[String, Option[String]]] =
    Future
      .traverse(vehicles)(vehicle => vehicle.isApiControlEnabled().map(_.map((vehicle.name, _))))
      .map: answers =>
        answers.collectFirst { case Right((name, false)) => name } match
          case Some(name) =>
            Right(Some(
              s"the simulator at $simulator no longer gives $name to this flight: it was started again, or another took api control away"
            ))
          case None => answers.collectFirst { case Left(error) => error.message }.toLeft(None)

  private val noSteps =
    "paused needs a simulator whose time passes in steps, which MAVLink's vehicles have not"

  /** What of a solver's events a person is told at once. */
  private val told = Set(EventKind.Disconnected, EventKind.Reconnected, EventKind.Refused)

  private val anyPort = Address("127.0.0.1", 0)

  private[flight] val version = Option(getClass.getPackage.getImplementationVersion).getOrElse("development")

  /** What of the client's events a recording keeps; failed calls are recorded by whoever called. */
  private def eventOf(event: RpcEvent): Option[(EventKind, String)] = event match
    case RpcEvent.Disconnected(lane, connection, reason) =>
      Some(EventKind.Disconnected -> s"$lane connection $connection: $reason")
    case RpcEvent.ConnectFailed(lane, connection, reason) =>
      Some(EventKind.Disconnected -> s"$lane connection $connection: $reason")
    case RpcEvent.LateReply(method, _, _, after) =>
      Some(EventKind.LateReply -> s"$method answered after ${after.toMillis.fixed(0)} ms")
    case _ => None
