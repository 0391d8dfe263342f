package skein.buffer

import java.util.concurrent.atomic.AtomicReference
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.actor.typed.scaladsl.adapter.*
import org.apache.pekko.actor.typed.scaladsl.{ActorContext, Behaviors, TimerScheduler}
import org.apache.pekko.actor.typed.{ActorRef, Behavior}
import org.apache.pekko.stream.scaladsl.BidiFlow
import scala.collection.mutable
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.airsim.{AirSimClient, AirSimError, MoveQueue, Multirotor}
import skein.buffer.Buffers.{Order, Stepped, Verdict}
import skein.link.{Address, LinkProxy, Transport}
import skein.rpc.{RpcClient, RpcError}
import skein.signal.Stamped
import skein.simulator.{PlanCall, PlannedMove}
import skein.units.*

/** A buffer of plans on the side of a simulator that has none, such as AirSim: takes plans out of its
  * clients' connections, and performs their moves at their moments by the simulator's ordinary functions,
  * over connections of its own. It belongs near the simulator, behind the link that delays its clients: see
  * [[LinkProxy.start]].
  *
  * Moves begin half a round trip to the simulator after their moments, if the machine is fast enough. The
  * simulator's clock is known to half a round trip, and in AirSim to a step of physics. If the clock is
  * stopped, set or started, the buffer notices it within 20 ms; moves due meanwhile are early or late by as
  * much.
  *
  * A simulator with a buffer of its own, such as `./skein serve`, receives no plans either.
  *
  * One actor holds the [[Buffers]] of all vehicles.
  */
final class SimulatorBuffer private (
    keeper: ActorRef[SimulatorBuffer.Message],
    client: AirSimClient,
    counted: AtomicReference[BufferCounts]
):
  import SimulatorBuffer.Message

  private object judge extends BufferStage.Judge:
    def judge(wish: Wish): Future[Verdict] =
      val verdict = Promise[Verdict]()
      keeper ! Message.Received(wish, verdict)
      verdict.future
    def answered(vehicle: String): Unit = keeper ! Message.Answered(vehicle)
    def lost(): Unit                    = keeper ! Message.Lost

  /** The stage for one connection between a client and the simulator. */
  def passing(): LinkProxy.Passing = BidiFlow.fromGraph(BufferStage(judge))

  def counts: BufferCounts = counted.get

  /** Sends no more moves, and closes its connections. */
  def close(): Future[Done] =
    keeper ! Message.Stop
    client.close()

object SimulatorBuffer:

  /** Starts a buffer, which connects to the simulator at the first plan.
    *
    * @param simulator the simulator's address, behind the link
    * @param onLost called with a line for each move whose answer was lost
    */
  def start(
      simulator: Address,
      transport: Transport,
      clock: Clock,
      onLost: String => Unit = _ => ()
  )(using system: ActorSystem): SimulatorBuffer =
    val client  = AirSimClient(RpcClient(transport, simulator, clock), AnswerWithin)
    val counted = AtomicReference(BufferCounts())
    val keeper  = system.spawnAnonymous(Behaviors.setup[Message](context =>
      Behaviors.withTimers(Keeping(client, clock, onLost, counted, context, _).behavior)
    ))
    SimulatorBuffer(keeper, client, counted)

  /** Time-out of a reading, and of a move's answer after the move's duration. */
  private val AnswerWithin = Span.ofSeconds(2)

  private[buffer] enum Message:
    case Received(wish: Wish, verdict: Promise[Verdict])

    case Answered(vehicle: String)

    case Looked(vehicle: String, answer: Either[String, Stamped[?]], unnamed: Option[String])

    /** The simulator has answered a move of the buffer. */
    case Ended(vehicle: String, isDone: Boolean)
    case Lost
    case Due
    case Stop

  private final class Keeping(
      client: AirSimClient,
      clock: Clock,
      onLost: String => Unit,
      counted: AtomicReference[BufferCounts],
      context: ActorContext[Message],
      timers: TimerScheduler[Message]
  )(using ActorSystem):
    private given ExecutionContext = ExecutionContext.parasitic

    private val verdicts   = mutable.LongMap.empty[Promise[Verdict]]
    private val vehicles   = mutable.HashMap.empty[String, (Multirotor, MoveQueue)]
    private var nextTicket = 0L
    private var buffers    = Buffers()
    private var wakesAt    = Option.empty[Instant]
    private var unnamed    = Option.empty[String]
    private val self       = context.self

    def behavior: Behavior[Message] = Behaviors.receiveMessage: message =>
      val now = clock.now()
      message match
        case Message.Received(wish, verdict) =>
          val ticket = nextTicket
          nextTicket += 1
          verdicts.update(ticket, verdict)
          follow(buffers.received(ticket, wish, now))
        case Message.Answered(vehicle)                => follow(buffers.answered(vehicle, now))
        case Message.Looked(vehicle, answer, default) =>
          unnamed = unnamed.orElse(default)
          follow(buffers.looked(vehicle, answer, unnamed.getOrElse(""), now))
        case Message.Ended(vehicle, isDone) => follow(buffers.ended(vehicle, isDone, now))
        case Message.Lost                   => follow(Stepped(buffers.lost()))
        case Message.Due                    =>
          wakesAt = None
          follow(buffers.due(now))
        case Message.Stop => Behaviors.stopped

    private def follow(step: Stepped): Behavior[Message] =
      buffers = step.buffers
      counted.set(buffers.counts)
      step.orders.foreach:
        case Order.Judge(ticket, verdict) => verdicts.remove(ticket).foreach(_.success(verdict))
        case Order.Look(vehicle)          => look(vehicle)
        case Order.Move(vehicle, move)    => perform(vehicle, move)
      val now = clock.now()
      for at <- buffers.wakeAt(now) if wakesAt.forall(at < _) do
        wakesAt = Some(at)
        if at <= now then self ! Message.Due
        else timers.startSingleTimer(Message.Due, at.since(now).toDuration)
      Behaviors.same

    private def perform(name: String, move: PlannedMove): Unit =
      val (multirotor, moves) = vehicles.getOrElseUpdate(name, named(name))
      moves
        .send(multirotor.perform(move.method, move.params, move.lasts, _))
        .onComplete(result => self ! Message.Ended(name, result.toOption.exists(_.isRight)))

    private def named(name: String): (Multirotor, MoveQueue) =
      val multirotor = Multirotor(client, name, connectionKey = vehicles.size)
      (multirotor, MoveQueue(multirotor, lost => onLost(s"$name: $lost")))

    private def look(name: String): Unit =
      for
        default <- unnamed.fold(defaultVehicle())(known => Future.successful(Some(known)))
        answer  <- Multirotor(client, name).kinematics()
      do self ! Message.Looked(name, answer.left.map(reason), default)

    /** Name of the simulator's default vehicle: empty if its settings are not understood, None if it does not
      * answer.
      */
    private def defaultVehicle(): Future[Option[String]] = client.settings().map:
      case Right(settings)           => Some(settings.defaultVehicle.name)
      case Left(AirSimError.Call(_)) => None
      case Left(_)                   => Some("")

    private def reason(error: RpcError): String = error match
      case RpcError.Refused(_, text) => PlanCall.reasonIn(text)
      case other                     => other.message
