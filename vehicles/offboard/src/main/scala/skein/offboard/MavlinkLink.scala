package skein.offboard

import java.util.concurrent.atomic.AtomicLong
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.stream.{BoundedSourceQueue, QueueOfferResult}
import org.apache.pekko.util.ByteString
import scala.collection.concurrent.TrieMap
import scala.concurrent.{Future, Promise}
import scala.util.Try
import skein.mavlink.*
import skein.mavlink.CommonDialect.Command
import skein.port.VehicleError
import skein.signal.ClockAlignment
import skein.units.*

/** Vehicles that speak MAVLink over one connection. This end acts as a ground station: it sends heartbeats,
  * and a TIMESYNC after every setpoint.
  *
  * @param systems the vehicles' numbers, in the flight's order
  * @param origin geographic origin of the flight's frame; without it, the origin of the first vehicle's own
  *   frame
  */
final class MavlinkLink private (
    systems: Vector[Int],
    origin: Option[GeoLocation],
    clock: Clock,
    settings: OffboardSettings,
    isDatagrams: Boolean,
    queue: BoundedSourceQueue[ByteString]
)(using system: ActorSystem):
  import MavlinkLink.*
  import system.dispatcher

  private val reader   = FrameReader()
  private val writer   = FrameWriter(GroundStation, Component)
  private val tokens   = AtomicLong()
  private val waiting  = TrieMap.empty[Long, Promise[Control.Answer]]
  private val controls = TrieMap.from(systems.map(number => number -> Control(number, settings)))
  private val ready    = Promise[Unit]()
  private val unsent   = AtomicLong()
  private var beatAt   = Instant.Epoch

  /** Datagrams dropped because the connection had no room. */
  def dropped: Long = unsent.get

  def control(number: Int): Control = controls(number)

  /** The relation of the flight's clock, which is the first vehicle's clock, to the controller's clock; None
    * before the first exchange.
    */
  def clocks: Option[ClockAlignment] = controls(systems.head).clock.map(_.alignment)

  /** Sends a request to one vehicle's control. */
  private[offboard] def ask(number: Int)(what: Control.Request): Future[Control.Answer] =
    val token   = tokens.getAndIncrement()
    val promise = Promise[Control.Answer]()
    waiting(token) = promise
    if isClosed then end(Closed)
    change(number)(what(_, token, clock.now()))
    promise.future

  @volatile private var isClosed = false

  private def change(number: Int)(step: Control => Control.Step): Unit =
    val answers = synchronized:
      val done = step(controls(number))
      controls(number) = done.next
      send(done.messages)
      done.answers
    for (token, answer) <- answers; promise <- waiting.remove(token) do promise.trySuccess(answer)

  private def send(messages: Vector[Message]): Unit =
    if messages.nonEmpty then
      val bytes = ByteString.fromArrayUnsafe(messages.flatMap(writer.write).toArray)
      if queue.offer(bytes) != QueueOfferResult.Enqueued then
        val _ = unsent.incrementAndGet()

  private def receive(bytes: ByteString): Unit =
    val now    = clock.now()
    val frames = synchronized:
      if isDatagrams then reader.readDatagram(bytes.toArrayUnsafe()) else reader.read(bytes.toArrayUnsafe())
    for frame <- frames if frame.component == 1 && controls.contains(frame.system) do
      val isNew = controls(frame.system).heardAt.isEmpty
      change(frame.system)(_.heard(frame.message, now))
      if isNew then greet(frame.system)
    settle()

  /** Requests the messages that control needs from a vehicle. */
  private def greet(number: Int): Unit = synchronized:
    def every(id: Int, micros: Float) =
      CommandLong(number, 1, Command.SetMessageInterval, 0, id.toFloat, micros, 0, 0, 0, 0, 0)
    val sampled = Samples.map(every(_, (settings.sampleEvery.toNanos / 1000).toFloat))
    val muted   = Unneeded.map(every(_, -1))
    send(sampled ++ muted :+ CommandLong(number, 1, Command.RequestMessage, 0, 49, 0, 0, 0, 0, 0, 0))

  /** Fixes the flight's frame and clock once all vehicles are known. */
  private def settle(): Unit = synchronized:
    if systems.forall(number => controls(number).isReady) then
      val reference = controls(systems.head).clock
      for number <- systems do
        val one  = controls(number)
        val from = origin.orElse(controls(systems.head).origin).get
        // Altitudes are relative to each vehicle's start, as in its own frame.
        val at = if ready.isCompleted then one.originNed else one.origin.get.nedFrom(from).copy(z = 0)
        controls(number) = one.copy(originNed = at).inTimeOf(reference)
      val _ = ready.trySuccess(())

  private def tick(): Unit =
    val now = clock.now()
    if now >= beatAt then
      beatAt = now + Beat
      synchronized(send(Vector(Heartbeat(6, 8, 0, 0, 4, 3))))
      for number <- systems if !ready.isCompleted && controls(number).heardAt.isDefined do greet(number)
    systems.foreach(number => change(number)(_.passed(now)))

  private def end(why: VehicleError): Unit =
    for token <- waiting.keys; promise <- waiting.remove(token) do promise.trySuccess(Left(why))

  private val ticking =
    system.scheduler.scheduleAtFixedRate(Control.Tick.toDuration, Control.Tick.toDuration)(() => tick())

  /** Closes the link. Vehicles continue as their autopilots do without it: they leave offboard after their
    * own timeout.
    */
  def close(): Future[Done] =
    ticking.cancel()
    isClosed = true
    // Completing a queue whose stream has ended throws.
    val _ = Try(queue.complete())
    end(Closed)
    Future.successful(Done)

object MavlinkLink:
  private val Closed        = VehicleError.Cancelled("the link was closed")
  private val GroundStation = 245
  private val Component     = 190
  private val Beat          = Span.ofSeconds(0.5)

  /** ODOMETRY, LOCAL_POSITION_NED, ATTITUDE_QUATERNION. */
  private val Samples = Vector(331, 32, 31)

  /** Frequent messages that are not needed: GPS_RAW_INT, ATTITUDE, GLOBAL_POSITION_INT. On an ordered link
    * every message delays those behind it.
    */
  private val Unneeded = Vector(24, 30, 33)

  /** Maximum number of datagrams that wait for the connection. */
  private val Waiting = 256

  /** Opens a link and waits for all vehicles.
    *
    * @param connection takes bytes for the vehicles and emits theirs
    * @param within the time for all vehicles to become ready
    * @param isDatagrams whether it emits datagrams, each of which ends its frames, and not pieces of a stream
    * @return Left lists the vehicles that did not become ready
    */
  def open(
      connection: Flow[ByteString, ByteString, ?],
      systems: Vector[Int],
      clock: Clock,
      origin: Option[GeoLocation] = None,
      settings: OffboardSettings = OffboardSettings(),
      within: Span = Span.ofSeconds(15),
      isDatagrams: Boolean = false
  )(using system: ActorSystem): Future[Either[VehicleError, MavlinkLink]] =
    import system.dispatcher
    val (queue, out) = Source.queue[ByteString](Waiting).preMaterialize()
    val link         = MavlinkLink(systems, origin, clock, settings, isDatagrams, queue)
    val ended        = out.via(connection).toMat(Sink.foreach(link.receive))(Keep.right).run()
    ended.onComplete: how =>
      link.end(VehicleError.Lost(
        s"the link has ended${how.failed.fold(_ => "", e => s": ${e.getMessage}")}",
        mayHaveRun = true
      ))
    val late = org.apache.pekko.pattern.after(within.toDuration, system.scheduler)(Future.successful(false))
    val lost = ended.transform(_ => scala.util.Success(false))
    Future
      .firstCompletedOf(Seq(link.ready.future.map(_ => true), late, lost))
      .flatMap:
        case true  => Future.successful(Right(link))
        case false =>
          val missing = systems.map(number => number -> link.control(number).missing).filter(_._2.nonEmpty)
          val told    = missing.map((number, what) => s"$number lacks ${what.mkString(", ")}")
          link.close().map(_ =>
            Left(VehicleError.Unreachable(
              s"expected MAVLink systems ${systems.mkString(", ")} within " +
                s"${within.toSeconds.round} s; ${told.mkString("; ")}"
            ))
          )
