package skein.airsim.simulator

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.actor.typed.scaladsl.adapter.*
import org.apache.pekko.actor.typed.scaladsl.{Behaviors, TimerScheduler}
import org.apache.pekko.actor.typed.{ActorRef, Behavior}
import java.util.concurrent.atomic.AtomicLong
import scala.collection.mutable
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.link.{Address, Clock, Transport}
import skein.rpc.{RpcRequest, RpcServer, ServerStats}
import skein.units.*
import upack.Msg

/** The built-in simulator behind a socket, or whatever a [[Transport]] has: it speaks AirSim's wire, so that any of its
  * clients can fly it.
  *
  * One actor holds the [[Simulation]]. Physics is computed up to the clock's present whenever a call comes and whenever
  * a move may end, and every 50 ms at the latest; while the simulator is paused, nothing runs.
  */
final class SimulatorServer private (
    server: RpcServer,
    simulator: ActorRef[SimulatorServer.Message],
    behindNanos: AtomicLong
):

  /** Where it listens, with the actual port. */
  def address: Address = server.address

  def stats: ServerStats = server.stats

  /** Simulated time skipped so far because the machine was too slow, or asleep. */
  def behind: Span = Span.ofNanos(behindNanos.get)

  /** Stops listening and closes all connections; moves under way are not answered. */
  def close(): Future[Done] =
    simulator ! SimulatorServer.Message.Stop
    server.close()

object SimulatorServer:

  /** Starts a simulator. The future fails with the transport's error if it cannot listen there, such as
    * [[skein.link.TransportError.PortTaken]].
    */
  def start(settings: SimulatorSettings, transport: Transport, clock: Clock)(using
      system: ActorSystem
  ): Future[SimulatorServer] =
    given ExecutionContext = ExecutionContext.parasitic
    val behind             = AtomicLong()
    val simulator          = system.spawnAnonymous(Behaviors.withTimers(running(settings, clock, behind)))
    val bound              = RpcServer.bind(transport, settings.address, settings.limits): request =>
      val answer = Promise[Either[String, Msg]]()
      simulator ! Message.Call(request, answer)
      answer.future
    bound.failed.foreach(_ => simulator ! Message.Stop)
    bound.map(SimulatorServer(_, simulator, behind))

  private[simulator] enum Message:
    case Call(request: RpcRequest, answer: Promise[Either[String, Msg]])
    case Wake
    case Stop

  private def running(settings: SimulatorSettings, clock: Clock, behind: AtomicLong)(
      timers: TimerScheduler[Message]
  ): Behavior[Message] =
    val simulation = Simulation(settings, clock.now())
    val waiting    = mutable.LongMap.empty[Promise[Either[String, Msg]]]
    var nextToken  = 0L
    var wakeAt     = Option.empty[Instant]

    def goOn(): Unit =
      for answer <- simulation.takeAnswers() do
        waiting.remove(answer.token).foreach(_.success(answer.result))
      behind.set(simulation.behind.toNanos)
      val now = clock.now()
      for at <- simulation.nextWake(now) if wakeAt.forall(at < _) do
        wakeAt = Some(at)
        timers.startSingleTimer(Message.Wake, at.since(now).toDuration)

    goOn()
    Behaviors.receiveMessage:
      case Message.Call(request, answer) =>
        waiting.update(nextToken, answer)
        simulation.receive(SimulatorCall(nextToken, request.method, request.params), clock.now())
        nextToken += 1
        goOn()
        Behaviors.same
      case Message.Wake =>
        wakeAt = None
        simulation.advance(clock.now())
        goOn()
        Behaviors.same
      case Message.Stop => Behaviors.stopped
