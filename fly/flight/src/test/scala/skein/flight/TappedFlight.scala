package skein.flight

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Source}
import org.apache.pekko.util.ByteString
import scala.collection.mutable
import scala.concurrent.Future
import skein.forward.RecordedDelays
import skein.link.*
import skein.record.{MemoryRecorder, Recording}
import skein.rpc.{Framed, Framer, RpcMessage}
import skein.settings.{FlightPlan, FlySettings}
import skein.units.*
import skein.vtime.VirtualTime
import upack.Str

/** A flight in virtual time with the arrival times of its moves at the simulator.
  *
  * @param startedAt when the loop began, and for how long the vehicles had hovered by then
  * @param arrivedAt arrival times of each vehicle's moves, ascending
  */
final case class TappedFlight(
    recording: Recording,
    startedAt: Instant,
    hovered: Span,
    arrivedAt: Map[String, Vector[Instant]]
):
  private val vehicles = recording.heading.vehicles.map(_.name).toVector

  def delays: RecordedDelays = RecordedDelays(vehicles.map: vehicle =>
    val readings = recording.readings.filter(_.vehicle == vehicle).map(r => r.sequence -> r.state)
    val commands = recording.commands.filter(_.vehicle == vehicle).sortBy(_.sentAt.toNanos)
    val answers  =
      recording.acknowledgements.filter(_.vehicle == vehicle).map(a => a.command -> a.endedAt).toMap
    val arrivals = arrivedAt(vehicle)
    val replaced =
      for (command, next) <- commands.zip(arrivals.drop(1)) yield answers(command.sequence).since(next)
    Vector(
      byNumber(readings.map((number, state) => number -> state.validAt.since(state.sentAt))),
      byNumber(readings.map((number, state) => number -> state.receivedAt.since(state.validAt))),
      commands.zip(arrivals).map((command, at) => at.since(command.sentAt).toNanos).toArray,
      replaced.map(_.toNanos).toArray
    ))

  private def byNumber(delays: Seq[(Long, Span)]): Array[Long] =
    val known = delays.toMap
    Array.tabulate(known.keys.max.toInt + 1)(n => known.get(n).fold(RecordedDelays.Lost)(_.toNanos))

object TappedFlight:

  def fly(settings: FlySettings, plan: FlightPlan): TappedFlight =
    VirtualTime
      .run(plan.seed): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock     = Clock.ofNanos(VirtualTime.clock(system))
        val began     = clock.now()
        val tap       = MoveTap(MemoryNetwork(NetworkPlan(), plan.seed, clock).host("localhost"), clock)
        val assembler = FlightAssembler(tap, clock, settings, simulator = None)
        val recorder  = MemoryRecorder(assembler.heading(plan, clockKind = "virtual"))
        assembler
          .start(plan, recorder)
          .flatMap:
            case Left(reason)    => Future.failed(IllegalStateException(reason))
            case Right(assembly) =>
              val startedAt = clock.now()
              assembly.landed.map(_ =>
                TappedFlight(recorder.recording, startedAt, startedAt.since(began), tap.arrivals)
              )
      .value

/** A transport that records when moves arrive at the first listener: the simulator. */
private final class MoveTap(transport: Transport, clock: Clock) extends Transport:
  private val arrived   = mutable.Map.empty[String, Vector[Instant]].withDefaultValue(Vector.empty)
  private var listeners = 0

  def arrivals: Map[String, Vector[Instant]] = arrived.toMap

  def connect(to: Address): Flow[ByteString, ByteString, Future[Done]] = transport.connect(to)

  def listen(at: Address): Source[Incoming, Future[Listening]] =
    listeners += 1
    if listeners > 1 then transport.listen(at)
    else
      transport
        .listen(at)
        .map: incoming =>
          val framer = new Framer()
          incoming.copy(flow = incoming.flow.map(bytes => { note(framer, bytes); bytes }))

  private def note(framer: Framer, bytes: ByteString): Unit =
    framer.offer(bytes)
    var framed = framer.next()
    while framed != Framed.NeedsMore do
      framed match
        case Framed.Complete(frame) =>
          RpcMessage.fromClient(frame) match
            case RpcMessage.Request(_, "moveByVelocityZ" | "moveByVelocity" | "moveToPosition", params) =>
              params.last match
                case Str(vehicle) => arrived(vehicle) = arrived(vehicle) :+ clock.now()
                case other        => throw IllegalStateException(s"no vehicle's name: $other")
            case _ => ()
        case other => throw IllegalStateException(other.toString)
      framed = framer.next()
