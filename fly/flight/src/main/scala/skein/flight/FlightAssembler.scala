package skein.flight

import java.util.concurrent.atomic.AtomicBoolean
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.Materializer
import org.apache.pekko.stream.scaladsl.Flow
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.airsim.{Vehicles, WorldSettings}
import skein.flow.Hold
import skein.forward.Asking
import skein.link.*
import skein.loop.*
import skein.loop.learning.{Learning, Lessons, LessonsAgain, LessonsBeside}
import skein.loop.planning.{CountedPlanWorkers, PlanThread, PlanWorkers, ThreadedPlanWorkers}
import skein.policy.{ActionGuidance, Fleet}
import skein.port.{CommandPlan, SteppedTime, VehicleError, VehiclePort}
import skein.record.*
import skein.settings.{ChosenPolicy, FlightPlan, FlySettings, PolicyFile, RecordedPlan, Wire}
import skein.scene.Moment
import skein.signal.{LatencyProfile, SplitMix64}
import skein.solver.{Briefing, SolverClient}
import skein.simulator.{MavlinkSettings, SimulatedSensing, SimulatorServer, SimulatorSettings}
import skein.units.*
import skein.units.Decimals.brief

/** Assembles flights from settings and plans.
  *
  * @param simulator the address of a running simulator; without one, each flight has its own built-in
  *   simulator
  * @param workers search on behalf of flights that plan
  * @param tell called with a line for the user when something goes wrong in flight
  * @param learnsOn threads for policies that learn during the flight; without it, each has its own thread of
  *   low priority
  * @param solvers the links to solvers, for flights that another process decides for
  * @param calledOff why a flight, by its name, must stop while it waits for its solver, or its vehicles move
  *   to their starts
  * @param isWatched whether its records are shown, so that images and clouds that are not recorded are still
  *   offered
  * @param isMavlinkByTcp whether `simulator`, if it speaks MAVLink, is reached by TCP instead of datagrams
  * @param elsewhere vehicles to fly instead of a simulator's; not in `paused`, and over no link with a rate
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
    isWatched: Boolean = false,
    isMavlinkByTcp: Boolean = false,
    elsewhere: Option[VehicleSource] = None
)(using system: ActorSystem):
  import system.dispatcher

  /** Whether a record is kept in the recording, and not only shown. */
  private[flight] def keeps(record: Recordable): Boolean = record match
    case row: Record => ImagingSensor.of(row).forall(settings.recordedImaging)
    case _           => true

  /** Whether other clients may command the vehicles too. */
  private val isShared = simulator.isDefined || elsewhere.isDefined

  /** Vehicles, starts and roles, equal in all flights; the policies are the plan's. */
  private val fleet: Fleet = settings.fleet

  def heading(plan: FlightPlan, clockKind: String): RecordingHeader = RecordingHeader(
    FlightRow(
      plan.id,
      plan.loop.label,
      plan.link.name,
      plan.seed,
      settings.period,
      settings.duration,
      clockKind,
      elsewhere.map(_.where).orElse(simulator.map(_.toString)).fold(Simulator.BuiltIn)(Simulator.Other(_)),
      settings.scenario.title +
        plan.policy.fold("")(chosen => s", ${PolicyFile.name(chosen.file.role)} ${chosen.file.label}"),
      FlightAssembler.version,
      clock.now(),
      Some(settings.scenario.name)
    ),
    fleet.agents.map(VehicleRow.of),
    RecordedPlan.parameters(settings, plan) ++ fleet.agents.flatMap(agent =>
      VehicleRow.kind(agent.name, agent.kind)
    )
  )

  /** Prepares and starts a flight. If it cannot start, everything opened for it is closed again.
    *
    * @param on the materializer of its loop: see [[Flight.start]]
    * @return Left says why it cannot start
    */
  def start(
      plan: FlightPlan,
      recorder: Recorder,
      on: Option[Materializer] = None
  ): Future[Either[String, FlightAssembly]] = Start(plan, recorder, on).begun()

  private final class Start(plan: FlightPlan, recorder: Recorder, on: Option[Materializer]):
    private val opened    = Opened()
    private val isAirSims = simulator.isDefined && settings.wire == Wire.AirSim
    private val monitor   = FlightMonitor(
      recorder,
      isStepped = plan.loop == LoopKind.Paused,
      hasPlaces = isAirSims && settings.sensors.isEmpty,
      movesLast = Option.when(isAirSims)(settings.loopSettings(plan).moveDuration)
    )
    private val isFlying = AtomicBoolean()
    private val isOver   = AtomicBoolean()
    private val sensing  = settings.sensors.map: noise =>
      SimulatedSensing(
        noise,
        SplitMix64.seedOf(plan.seed, -1),
        seen =>
          // MAVLink's vehicles count time from their boot.
          val at = if settings.wire == Wire.Mavlink then Instant.Epoch + seen.sinceStart else seen.at
          if !isOver.get then monitor.offer(Truth(seen.vehicle, at, seen.positionNed))
        ,
        () => isFlying.get
      )

    def begun(): Future[Either[String, FlightAssembly]] =
      val starting =
        for
          server <- serve()
          _ = server.foreach(opened.closing(_)(_.close()))
          _       <- notApart.fold(Future.unit)(why => Future.failed(CannotFly(s"decentralised: $why")))
          solver  <- connectedSolver
          reached <- elsewhere match
            case Some(source) => fromSource(source)
            case None         =>
              settings.wire match
                case Wire.AirSim  => overAirSim(server.fold(simulator.get)(_.address)).connect()
                case Wire.Mavlink => overMavlink(server)
          _ <- packets(reached)
          _ <- Team.missingSensor(fleet, reached.vehicles, settings.own).fold(reached.ping().map(_ => ()))(
            missing =>
              Future.failed(CannotFly(missing))
          )
        yield
          val loopSettings =
            settings.loopSettings(plan).copy(guidance = elsewhere.fold(ActionGuidance.of)(_.guidance))
          val planners =
            if plan.loop != LoopKind.Plan || solver.isDefined then PlanWorkers.none
            else
              opened.closingNow(workers(settings.planning))(_.close())
          val endCondition = EndCondition(
            settings.scenario,
            plan.loop == LoopKind.Paused,
            settings.isDecentralised(plan),
            monitor
          )
          val flown = plan.policy.fold(plan.fleet(settings))(learning)
          val hold  = Hold()

          val network = settings.between.filter(_ => reached.apart.nonEmpty).map: link =>
            val inScene = Moment(settings.world.scene, Vector.empty)
            val seed    = SplitMix64.seedOf(plan.seed, FlySettings.MostControllers)
            opened.closing(
              VehicleNetwork(fleet.agents.map(_.name), link, seed, inScene.sees(_, _), clock, monitor)
            )(_.close())

          def team(vehicles: Vector[VehiclePort], only: Option[Int]) = Team(
            flown,
            vehicles,
            clock,
            endCondition,
            loopSettings,
            planners,
            solver,
            reached.clocks,
            only,
            hold,
            only.flatMap(self => network.map(_.of(self)))
          )
          val teams =
            if reached.apart.isEmpty then Vector(team(reached.vehicles, None))
            else reached.apart.map(one => team(one.vehicles, Some(one.self)))
          isFlying.set(true)
          val startedAt = clock.now()
          val watchdog  = SimulatorWatchdog(
            monitor,
            clock,
            startedAt,
            SimulatorWatchdog.within(settings.period, Asking.Timeout),
            reached.where,
            reached.isOther,
            reached.ping,
            isShared,
            () => teams.flatMap(_.underDecision).minByOption(_.since),
            line => tell(s"${plan.id}: $line")
          )
          val flight = Flight.start(
            plan.loop,
            teams.head,
            reached.time.map(FlightAssembler.noting(_, () => isOver.set(true))),
            settings.duration,
            clock,
            endCondition,
            () => watchdog.onTime,
            on,
            teams.tail
          )
          flight.ending.foreach(_ => isOver.set(true))
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
            RunningGraph(
              teams.head.meters,
              flight.streams,
              reached.apart.headOption.map(one => fleet.agents(one.self).name)
            ),
            hold,
            monitor,
            watchdog,
            startedAt,
            clock,
            () => opened.close(),
            solver,
            () => server.fold(Span.Zero)(_.behind)
          ))
      starting
        .recoverWith { case error => opened.close().transformWith(_ => Future.failed(error)) }
        .recover { case error: (TransportError | CannotFly | SolverClient.NoSolver) =>
          Left(error.getMessage)
        }

    /** The remote solver of the flight, after it has accepted the flight. */
    private def connectedSolver: Future[Option[SolverClient]] =
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
                (kind, vehicle, detail, count) =>
                  val (who, what) = (vehicle.map(agents(_).name), Some(EventSubject.Solver))
                  monitor.offer(Event(clock.now(), kind, who, detail, about = what, count = count))
                  if FlightAssembler.told(kind) then tell(s"${plan.id}: $detail")
              ))(_.close())
              val waits = system.scheduler.scheduleOnce(solvers.toldAfter.toDuration):
                val most = solvers.patience.toSeconds.brief
                tell(s"${plan.id}: waits for --solver ${choice.text}, $most s at most: ${client.whyNone}")
              unlessCalledOff(client.ready(solvers.patience))
                .andThen(_ => waits.cancel())
                .recoverWith:
                  case no: SolverClient.NoSolver =>
                    Future.failed(CannotFly(s"--solver ${choice.text}: ${no.reason}"))
                .map(_ => Some(client))

    private def unlessCalledOff[A](waiting: Future[A]): Future[A] =
      val ready = Promise[A]().completeWith(waiting)
      val every = FlightAssembler.LookEvery.toDuration
      val calls = system.scheduler.scheduleWithFixedDelay(every, every): () =>
        calledOff(plan.id).foreach(why => ready.tryFailure(CannotFly(why)))
      ready.future.andThen(_ => calls.cancel())

    /** The fleet with policies that may learn during the flight. */
    private def learning(chosen: ChosenPolicy): Fleet =
      def taught(lessons: Lessons, explore: Double) =
        chosen.learningIn(plan.fleet(settings), lessons, explore, plan.seed, settings.period):
          (vehicle, decision, news) =>
            RecordedPlan.learned(clock.now(), vehicle, decision, news).foreach(monitor.offer)
      chosen.learning match
        case None                                  => plan.fleet(settings)
        case Some(Learning.Again(explore, news))   => taught(LessonsAgain(news), explore)
        case Some(Learning.Beside(explore, begun)) =>
          val on = learnsOn.getOrElse:
            val thread = BackgroundExecutor("skein-learn")
            // It may hang in a lesson, which is not awaited.
            opened.closingNow(ExecutionContext.fromExecutor(thread))(_ => thread.close())
          val lessons = opened.closingNow(LessonsBeside(begun(plan.seed), on))(_.close())
          taught(lessons, explore)

    private def overAirSim(at: Address): AirSimFleet = AirSimFleet(
      transport,
      clock,
      settings,
      plan,
      at,
      opened,
      monitor,
      startsAirborne = simulator.isEmpty,
      () => calledOff(plan.id),
      isWatched,
      tell
    )

    /** Connects over MAVLink: to the flight's own simulator by a byte stream, to any other by datagrams
      * unless configured otherwise.
      */
    private def overMavlink(server: Option[SimulatorServer]): Future[ConnectedFleet] =
      val at      = server.flatMap(_.peerAddresses.headOption).orElse(simulator).get
      val isTcp   = server.isDefined || isMavlinkByTcp
      val by      = if isTcp then transport else UdpTransport()
      def plain() = by.connect(at)
      def linked: Flow[ByteString, ByteString, ?] =
        if plan.link == LatencyProfile.none then plain()
        else
          EmulatedLink(LinkProfile.symmetric(plan.link), plan.seed, clock)
            .connection(TransportError.Lost(at, "the link broke"), isDatagrams = !isTcp)
            .join(plain())
      val origin  = server.map(_ => WorldSettings.DefaultOrigin)
      val mavlink =
        MavlinkFleet(fleet, clock, origin, plain, isDatagrams = !isTcp, () => calledOff(plan.id))
      for
        _ <-
          if plan.loop == LoopKind.Paused then Future.failed(CannotFly(FlightAssembler.noSteps("MAVLink")))
          else Future.unit
        _                <- mavlink.prepare()
        (link, vehicles) <- mavlink.open(linked)
      yield
        val _       = opened.closing(link)(_.close())
        val custody = MavlinkCustody(
          fleet.agents.map(_.name).zip(vehicles).map((name, vehicle) => (name, () => vehicle.taken)),
          monitor.isLanding
        )
        ConnectedFleet(
          vehicles,
          None,
          at.toString,
          () => vehicles.head.read().map(_.isRight),
          () => Future.successful(Right(custody.check())),
          clocks = link.clocks
        )

    /** Why each vehicle cannot have a controller of its own in this flight, if it should. */
    private def notApart: Option[String] =
      if !settings.isDecentralised(plan) then None
      else
        elsewhere
          .map(source => s"expected vehicles over AirSim's protocol, got those of ${source.where}")
          .orElse:
            Option.when(plan.policy.exists(_.learning.isDefined)):
              "expected policies that do not learn in flight, which is one learner for all"

    /** Requests whether the vehicles hold plans, if the flight sends them. */
    private def packets(reached: ConnectedFleet): Future[Unit] =
      if !settings.loopSettings(plan).planInPacket then Future.unit
      else if plan.policy.exists(_.learning.isDefined) then
        Future.failed(CannotFly("plan-in-packet: expected policies that do not learn in flight"))
      else
        // An outage that just happens says nothing of the vehicles.
        def certain(answer: Either[VehicleError, Boolean]) = answer.fold(_.isCertain, _ => true)
        Future.traverse(reached.vehicles)(one => UntilCertain(one.follow(CommandPlan.Question))(certain)).map:
          answers =>
            for error <- answers.flatMap(_.left.toOption).headOption do
              if !error.isCertain then
                throw CannotFly(
                  s"plan-in-packet: ${reached.where} did not say whether it takes plans: ${error.message}"
                )
              throw CannotFly(
                "plan-in-packet: expected a buffer of plans beside the vehicles, as the built-in simulator has and " +
                  s"`skein link --buffer` puts before AirSim, got ${reached.where}: ${error.message}"
              )

    private def fromSource(source: VehicleSource): Future[ConnectedFleet] =
      if plan.loop == LoopKind.Paused then Future.failed(CannotFly(FlightAssembler.noSteps(source.where)))
      else if plan.link.bandwidth.isDefined then
        Future.failed(CannotFly(
          s"expected a link without a rate to ${source.where}, whose messages have no known size, got ${plan.link.name}"
        ))
      else
        SourceFleet(source, fleet, clock, () => calledOff(plan.id)).connect(opened).map: reached =>
          if plan.link == LatencyProfile.none then reached
          else
            reached.copy(vehicles = reached.vehicles.zipWithIndex.map: (vehicle, line) =>
              LinkedVehicle(vehicle, plan.link, plan.seed, line, clock))

    private def serve(): Future[Option[SimulatorServer]] =
      if isShared then Future.successful(None)
      else
        val vehicles = fleet.agents.map(Vehicles.settings)
        val kind     = settings.plant.kind(plan.seed).fold(reason => throw CannotFly(reason), identity)
        SimulatorServer
          .start(
            SimulatorSettings(
              WorldSettings.of(vehicles, settings.scenario.equipment),
              FlightAssembler.anyPort,
              scene = settings.world.scene,
              mavlink =
                Option.when(settings.wire == Wire.Mavlink)(MavlinkSettings(listen =
                  Some(FlightAssembler.anyPort)
                )),
              kind = kind,
              sensing = sensing
            ),
            transport,
            clock
          )
          .map(Some(_))

object FlightAssembler:
  /** Planning threads, no more than there are cores. */
  def threads(planning: PlanSettings): PlanWorkers =
    new ThreadedPlanWorkers(
      planning.searches.min(Runtime.getRuntime.availableProcessors),
      planThreads("skein-plan")
    )

  /** Starts low-priority planning threads, which yield to those of control. */
  private[skein] def planThreads(name: String): (() => Boolean) => PlanThread =
    val (factory, usual) = (BackgroundThread.factory(name), BackgroundThread.usual(name))
    slice => asPlanThread(BackgroundThread(factory, usual)(slice))

  private[skein] def asPlanThread(thread: BackgroundThread): PlanThread = new PlanThread:
    def wake(): Unit  = thread.wake()
    def close(): Unit = thread.close()

  /** Planning in virtual time, where a search has a fixed number of slices. */
  def counted(planning: PlanSettings): PlanWorkers = CountedPlanWorkers(planning.searches, planning.slices)

  /** Calls `onResumed` before time runs again, which it does after a flight's last step. */
  private def noting(time: SteppedTime, onResumed: () => Unit): SteppedTime = new SteppedTime:
    export time.{continueFor, pause}
    def resume(): Future[Either[VehicleError, Unit]] =
      onResumed()
      time.resume()

  private def noSteps(where: String) =
    s"paused needs a simulator whose time passes in steps, which vehicles of $where have not"

  /** The events of a solver that are reported to the user immediately. */
  private val told = Set(EventKind.Disconnected, EventKind.Reconnected, EventKind.Refused)

  private val LookEvery = Span.ofMillis(100)

  private val anyPort = Address("127.0.0.1", 0)

  private[flight] val version = Option(getClass.getPackage.getImplementationVersion).getOrElse("development")
