package skein.simulator

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.actor.typed.scaladsl.adapter.*
import org.apache.pekko.actor.typed.scaladsl.{Behaviors, TimerScheduler}
import org.apache.pekko.actor.typed.{ActorRef, Behavior}
import org.apache.pekko.dispatch.Dispatchers
import org.apache.pekko.stream.{BoundedSourceQueue, QueueOfferResult}
import org.apache.pekko.util.ByteString
import java.util.concurrent.atomic.AtomicBoolean
import scala.collection.mutable
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.Try
import scala.util.control.NonFatal
import skein.link.{Address, Transport}
import skein.policy.Action
import skein.rpc.{CallLines, Encoded, RpcRequest, RpcServer, ServerEvent, ServerStats}
import skein.signal.Kinematics
import skein.units.*
import upack.{Bool, Msg}

/** The built-in simulator behind a [[Transport]], such as a socket: it speaks AirSim's protocol, so that any
  * of its clients can fly it.
  *
  * One actor holds the [[Simulation]]. Physics is computed up to the clock's present whenever a call is
  * received and whenever a move may end, and every 50 ms at the latest; while the simulator is paused,
  * nothing runs.
  *
  * Calls are run in rounds over the connections ([[CallLines]]), so that no client waits for another's whole
  * queue, and one that calls rarely goes first; calls of a connection that has closed before their turn are
  * not run. If the simulation itself fails, which is a defect, it stops listening, closes every connection
  * and completes [[failed]].
  */
final class SimulatorServer private (
    server: RpcServer,
    simulator: ActorRef[SimulatorServer.Message],
    running: SimulatorServer.Running,
    peers: Option[PeerServer]
):

  /** The listening address, with the actual port. */
  def address: Address = server.address

  /** The addresses on which MAVLink peers or external autopilots connect, with the actual ports: stream ports
    * first, then datagram ports. Empty without either.
    */
  def peerAddresses: Vector[Address] = peers.fold(Vector.empty)(_.addresses)

  def stats: ServerStats = server.stats.copy(dropped = running.lines.dropped)

  def peerStats: PeerStats = running.counters.stats.copy(ignored = peers.fold(0L)(_.ignored))

  /** Completes if it stops without having been closed, with the reason. */
  val failed: Future[Throwable] =
    given ExecutionContext = ExecutionContext.parasitic
    Future.firstCompletedOf(Seq(running.broken.future, server.failed))

  /** Simulated time skipped so far because the machine was too slow, or suspended. */
  def behind: Span = running.behind

  /** Whether moves have held all workers for longer than [[SimulatorSettings.patience]]. */
  def hasHeldUp: Boolean = running.hasHeldUp

  def commands: CommandCounts = running.commands

  /** The true motion of all vehicles; does not complete once the server is closed. */
  def truth(): Future[SimulatorServer.Truth] =
    val answer = Promise[SimulatorServer.Truth]()
    simulator ! SimulatorServer.Message.Look(answer)
    answer.future

  /** Lets a multirotor take off and perform an action from now on, if the server has an [[Onlooker]]. A move
    * started by a client ends.
    *
    * @param vehicle the vehicle's index in the settings
    * @param action the action for the vehicle's present motion, world NED; evaluated every 20 ms of simulated
    *   time
    * @param lasts simulated time after which a vehicle in the air holds its position; None: until the next
    *   action, or until a client moves or resets it
    * @param stamp time of the decision, on the simulator's clock, if known
    */
  def act(
      vehicle: Int,
      action: Kinematics => Action,
      lasts: Option[Span],
      stamp: Option[Instant] = None
  ): Unit = simulator ! SimulatorServer.Message.Act(vehicle, action, lasts, stamp)

  /** Stops listening and closes all connections; moves in progress are not answered. */
  def close(): Future[Done] =
    simulator ! SimulatorServer.Message.Stop
    given ExecutionContext = ExecutionContext.parasitic
    val peersClosed        = peers.fold(Future.successful(Done))(_.close())
    server.close().flatMap(_ => peersClosed)

object SimulatorServer:

  /** @param at time of the motion, on the simulator's clock
    * @param vehicles motion in world NED; number of contacts with objects of the scene since the start
    */
  final case class Truth(
      at: Instant,
      vehicles: Vector[(name: String, kinematics: Kinematics, contacts: Long)]
  )

  /** Starts a simulator. The future fails with the transport's error if it cannot listen there, such as
    * [[skein.link.TransportError.PortTaken]].
    *
    * @param onlooker sees the vehicles of the settings, which must be multirotors
    * @param step a multiple of 20 ms: the clock stops every `step` from the first [[act]] with a stamp on,
    *   until each vehicle that was commanded has a command stamped then or later, for at most a second
    */
  def start(
      settings: SimulatorSettings,
      transport: Transport,
      clock: Clock,
      onlooker: Option[Onlooker] = None,
      step: Option[Span] = None
  )(using system: ActorSystem): Future[SimulatorServer] =
    given ExecutionContext = ExecutionContext.parasitic
    val beside             = Beside(system.dispatchers.lookup(Dispatchers.DefaultBlockingDispatcherId))
    val running            = Running(Simulation(settings, clock.now()), onlooker, step, clock, beside)
    val simulator          = system.spawnAnonymous(Behaviors.withTimers(running.behavior))
    def forget(event: ServerEvent): Unit = event match
      case ServerEvent.Finished(connection)  => simulator ! Message.Gone(connection, isForgotten = false)
      case ServerEvent.Closed(connection, _) =>
        running.lines.forget(connection)
        beside.forget(connection)
        simulator ! Message.Gone(connection, isForgotten = true)
      case _ => ()
    val bound = RpcServer.bind(transport, settings.address, settings.limits, observer = forget): request =>
      val answer = Promise[Either[String, Msg | Encoded]]()
      running.lines.put(request.connection, Call(request, answer))
      if running.work.compareAndSet(false, true) then simulator ! Message.Work
      answer.future
    bound.failed.foreach(_ => simulator ! Message.Stop)
    for server <- bound; failure <- running.broken.future do
      system.log.error(failure, "the simulator has failed; it closes its port")
      server.close()
    val peers = new Peers:
      def joined(peer: JoinedPeer): Unit = simulator ! Message.Joined(peer)
      def heard(channel: Long, bytes: Array[Byte], done: Promise[Done]): Unit =
        simulator ! Message.Heard(channel, bytes, done)
      def left(channel: Long): Unit = simulator ! Message.Left(channel)
    for
      rpc  <- bound
      open <- settings.mavlink.map(PeerPorts.of(_)).orElse(settings.hil.map(PeerPorts.of(_))) match
        case None        => Future.successful(None)
        case Some(ports) =>
          PeerServer
            .start(ports, transport, peers, running.counters)
            .map(Some(_))
            .recoverWith: error =>
              simulator ! Message.Stop
              rpc.close().transformWith(_ => Future.failed(error))
    yield SimulatorServer(rpc, simulator, running, open)

  private[simulator] enum Message:
    /** Calls wait to be run. */
    case Work
    case Wake
    case Look(answer: Promise[Truth])
    case Act(vehicle: Int, action: Kinematics => Action, lasts: Option[Span], stamp: Option[Instant])
    case Stop

    case Gone(connection: Long, isForgotten: Boolean)

    /** Events of MAVLink peers and of autopilots. */
    case Joined(peer: JoinedPeer)
    case Heard(channel: Long, bytes: Array[Byte], done: Promise[Done])
    case Left(channel: Long)

  final private case class Call(request: RpcRequest, answer: Promise[Either[String, Msg | Encoded]])

  /** Calls run before other work of the process gets its turn: some 0.5 ms. */
  private val CallsAtOnce = 32

  /** What runs on the simulator's actor; other threads may use its public members. */
  final private class Running(
      simulation: Simulation,
      onlooker: Option[Onlooker],
      step: Option[Span],
      clock: Clock,
      beside: Beside
  ):
    val lines    = CallLines[Call](isUrgent = call => Simulation.isControl(call.request.method))
    val counters = PeerCounters()
    val broken   = Promise[Throwable]()

    /** Whether a [[Message.Work]] was sent but is not yet handled. */
    val work = AtomicBoolean()

    @volatile var behind: Span            = Span.Zero
    @volatile var hasHeldUp: Boolean      = false
    @volatile var commands: CommandCounts = CommandCounts.Zero

    private val waiting                        = mutable.LongMap.empty[Call]
    private var nextToken                      = 0L
    private var wakeAt                         = Option.empty[Instant]
    private val protocol: Option[PeerProtocol] =
      simulation.settings.mavlink.map(MavlinkVehicles(simulation, _))
        .orElse(simulation.settings.hil.map(HilVehicles(simulation, _)))
    private val inProcess = onlooker.map(InProcess(simulation, _, step))
    private val outs      = mutable.LongMap.empty[BoundedSourceQueue[ByteString]]

    def behavior(timers: TimerScheduler[Message]): Behavior[Message] = Behaviors.setup: context =>
      def goOn(): Unit =
        takeCalls()
        for answer <- simulation.takeAnswers() do
          waiting.remove(answer.token).foreach(complete(_, answer.result))
        for vehicles <- protocol; (channel, datagrams) <- vehicles.take(); out <- outs.get(channel) do
          for bytes <- datagrams do
            if out.offer(ByteString.fromArrayUnsafe(bytes)) == QueueOfferResult.Dropped then
              counters.dropped.incrementAndGet(): Unit
        behind = simulation.behind
        hasHeldUp = simulation.hasHeldUp
        inProcess.foreach(it => commands = it.commands)
        val now = clock.now()
        val due = (protocol.flatMap(_.nextDue) ++ inProcess.flatMap(_.nextDue)).flatMap(simulation.comesTo)
        for at <- (simulation.nextWake(now) ++ due.map(_.max(now))).minOption if wakeAt.forall(at < _) do
          wakeAt = Some(at)
          // A timer is late by up to its scheduler's tick.
          if at <= now then context.self ! Message.Wake
          else timers.startSingleTimer(Message.Wake, at.since(now).toDuration)
        val more = if simulation.isFree then !lines.isEmpty else lines.hasUrgent
        if more && work.compareAndSet(false, true) then context.self ! Message.Work

      def afterwards(handled: => Unit): Behavior[Message] =
        try
          handled
          goOn()
          Behaviors.same
        catch
          case NonFatal(failure) =>
            val _ = broken.trySuccess(failure)
            Behaviors.stopped

      val _ = afterwards(())
      Behaviors.receiveMessage: message =>
        if message == Message.Stop then Behaviors.stopped else afterwards(handle(message))

    private def handle(message: Message): Unit = message match
      case Message.Work => work.set(false)
      case Message.Wake =>
        wakeAt = None
        simulation.advance(clock.now())
      case Message.Look(answer) =>
        simulation.advance(clock.now())
        answer.success(truth): Unit
      case Message.Act(vehicle, action, lasts, stamp) =>
        simulation.advance(clock.now())
        inProcess.foreach(_.act(vehicle, action, lasts, stamp))
        // Answers the move that it has ended.
        simulation.advance(clock.now())
      case Message.Gone(connection, isForgotten) => simulation.depart(connection, isForgotten, clock.now())
      case Message.Joined(peer)                  =>
        outs.update(peer.channel, peer.out)
        protocol.foreach(_.join(peer.channel, peer.systems, peer.isDatagrams))
      case Message.Heard(channel, bytes, done) =>
        simulation.advance(clock.now())
        for vehicles <- protocol do
          vehicles.receive(channel, bytes)
          counters.damaged.set(vehicles.damaged)
          counters.unanswered.set(vehicles.unanswered)
        // The simulation may have waited for an autopilot.
        if simulation.settings.hil.nonEmpty then simulation.advance(clock.now())
        val _ = done.trySuccess(Done)
      case Message.Left(channel) =>
        val _ = outs.remove(channel)
        protocol.foreach(_.leave(channel))
      case Message.Stop => ()

    private def truth =
      val world = simulation.world
      Truth(
        world.now,
        world.vehicles.map: vehicle =>
          (
            name = vehicle.settings.name,
            kinematics = vehicle.worldMotion(world.now),
            contacts = vehicle.contacts
          )
      )

    /** Completes a call; images are drawn outside the simulation, which continues. */
    private def complete(call: Call, result: Either[String, Msg | Encoded | DeferredResult]): Unit =
      result match
        case Left(text)                     => call.answer.success(Left(text)): Unit
        case Right(value: (Msg | Encoded))  => call.answer.success(Right(value)): Unit
        case Right(drawing: DeferredResult) =>
          beside.put(call.request.connection)(call.answer.complete(Try(Right(drawing.result()))): Unit)

    /** Runs waiting calls while a worker is free. Calls that are not taken are dropped with their connection.
      * Calls that never wait behind moves are run in any case.
      */
    private def takeCalls(): Unit =
      var left = CallsAtOnce
      while left > 0 do
        left -= 1
        if simulation.isFree then
          lines.take() match
            case None       => left = 0
            case Some(call) => run(call)
        else
          lines.takeUrgent((call, earlier) => Simulation.supersedes(call.request, earlier.request)) match
            case None                     => left = 0
            case Some((call, superseded)) =>
              superseded.foreach(_.answer.success(Right(Bool(false))))
              run(call)

    private def run(call: Call): Unit =
      waiting.update(nextToken, call)
      simulation.receive(SimulatorCall(nextToken, call.request), clock.now())
      nextToken += 1
