package skein.flow

import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, FlowShape, Inlet, Outlet}
import scala.collection.immutable.Queue
import scala.concurrent.Future
import scala.util.Try
import scala.util.control.NonFatal
import skein.port.Moves
import skein.units.*

/** The events of a command: each command is `Sent` once and later `Ended` once. */
enum Steered[+C, +R]:
  case Sent(command: C, at: Instant)

  /** The vehicle's answer, or the failure of the call. */
  case Ended(command: C, at: Instant, result: Try[R])

/** Commands one vehicle without ever overloading its simulator.
  *
  * AirSim's move calls answer when the move ends, and each holds one of the server's workers until then; a
  * burst of moves freezes the server, and executes out of order. So at most two are outstanding, the one in
  * effect and the one that replaces it. The next is *pulled* only when the oldest has answered and the rate
  * cap allows it: upstream then decides on its newest knowledge ([[Pace]] keeps it the newest), instead of a
  * decision that ages here.
  *
  * A command whose answer is lost with its connection may continue to execute, and is no longer counted: with
  * the next two there would be three at the simulator. So the vehicle is parked first, repeatedly until it
  * confirms; then the executing command is known. A command that upstream emits meanwhile is sent first.
  *
  * While the vehicle is held ([[Hold]]), it is parked and upstream's commands are not sent.
  *
  *   - '''Emits when''' a command is sent or has ended, and downstream demands.
  *   - '''Backpressures when''' `mostOutstanding` commands are outstanding, within `minInterval` of the last
  *     one, while an answer is lost and the vehicle not parked, or while [[Steer.EventLimit]] events wait for
  *     downstream.
  *   - '''Completes when''' upstream has completed, the vehicle was parked or [[Steer.LastAttempts]] at it
  *     failed, and every call has ended.
  *   - '''Cancels when''' downstream cancels.
  *
  * @param minInterval minimum time between two commands sent: the rate cap
  * @param mostOutstanding maximum number of unanswered commands. More than [[Moves.InFlight]] let a link with
  *   a long round trip carry more than one command per round trip; only for links that never deliver several
  *   in a burst
  * @param parksInDoubt whether the vehicle is parked after a lost answer; needless where commands are
  *   numbered, so that a late command changes nothing
  * @param send sends one command; the future ends when the move ends
  * @param park makes the vehicle hover, so that the outstanding moves are answered; sent as the last command,
  *   and after a lost answer
  * @param isCertain whether a result proves that its command neither executes nor is in transit: the
  *   vehicle's own answer, or that it was never sent. A failed future never proves it
  * @param onUnsent called for a command that waited for the vehicle to be parked when upstream completed, or
  *   arrived while it was held
  * @param hold parks the vehicle for as long as it is held
  */
final class Steer[C, R](
    minInterval: Span,
    clock: Clock,
    mostOutstanding: Int = Moves.InFlight,
    parksInDoubt: Boolean = true
)(
    send: C => Future[R],
    park: () => Future[R],
    isCertain: R => Boolean = (_: R) => true,
    onUnsent: C => Unit = (_: C) => (),
    hold: Hold = Hold()
) extends GraphStage[FlowShape[C, Steered[C, R]]]:
  import Steered.*

  private val in  = Inlet[C]("Steer.in")
  private val out = Outlet[Steered[C, R]]("Steer.out")

  val shape: FlowShape[C, Steered[C, R]] = FlowShape(in, out)

  def createLogic(attributes: Attributes): GraphStageLogic =
    new TimerGraphStageLogic(shape) with InHandler with OutHandler:
      private var outstanding                  = 0
      private var nextAt                       = Instant.Epoch
      private var parkAt                       = Instant.Epoch
      private var held: Option[C]              = None
      private var doubtful                     = false
      private var parking                      = false
      private var lastAttempts                 = 0
      private var parked                       = false
      private var resting                      = false
      private var events: Queue[Steered[C, R]] = Queue.empty

      private val ended = getAsyncCallback[(C, Try[R])]: (command, result) =>
        outstanding -= 1
        if parksInDoubt && !result.toOption.exists(isCertain) then doubtful = true
        if outstanding > 0 then
          nextAt = nextAt.max(clock.now() + Moves.HandoverAllowed)
          parkAt = parkAt.max(clock.now() + Moves.HandoverAllowed)
        report(Ended(command, clock.now(), result))

      private val parkEnded = getAsyncCallback[(Boolean, Try[R])]: (last, result) =>
        outstanding -= 1
        parking = false
        val certain = result.toOption.exists(isCertain)
        resting = certain
        if certain then doubtful = false else parkAt = clock.now() + Steer.ParkAgain
        if last then parked = certain || lastAttempts == Steer.LastAttempts
        goOn()

      private val turned = getAsyncCallback[Unit]: _ =>
        resting = false
        goOn()
      private var listening = () => ()

      override def preStart(): Unit =
        listening = hold.listen(() => turned.invoke(()))
        pull(in)

      override def postStop(): Unit = listening()

      def onPush(): Unit =
        held = Some(grab(in))
        goOn()

      def onPull(): Unit = goOn()

      override def onUpstreamFinish(): Unit = goOn()

      override protected def onTimer(key: Any): Unit = goOn()

      private def report(event: Steered[C, R]): Unit =
        events = events.enqueue(event)
        goOn()

      private def goOn(): Unit =
        if isAvailable(out) then
          for (event, rest) <- events.dequeueOption do
            events = rest
            push(out, event)
        if parked || hold.isHeld then
          held.foreach(onUnsent)
          held = None
        if parked then
          if outstanding == 0 && events.isEmpty then completeStage()
        else if outstanding < mostOutstanding && !parking then
          if doubtful || isClosed(in) && held.isEmpty || hold.isHeld && !resting then
            from(parkAt)(parkNow(last = isClosed(in)))
          else if held.isDefined then held.foreach(sendNow)
          else if !hasBeenPulled(in) && events.size < Steer.EventLimit then from(nextAt)(pull(in))

      /** Acts if `time` has passed; else schedules another attempt for `time`. */
      private def from(time: Instant)(act: => Unit): Unit =
        val now = clock.now()
        if now >= time then act
        else if !isTimerActive(Steer.Later) then scheduleOnce(Steer.Later, time.since(now).toDuration)

      private def sendNow(command: C): Unit =
        val now = clock.now()
        held = None
        nextAt = now + minInterval
        outstanding += 1
        attempt(send(command))(result => ended.invoke((command, result)))
        report(Sent(command, now))

      private def parkNow(last: Boolean): Unit =
        parking = true
        outstanding += 1
        if last then lastAttempts += 1
        attempt(park())(result => parkEnded.invoke((last, result)))

      private def attempt(call: => Future[R])(onEnd: Try[R] => Unit): Unit =
        val running =
          try call
          catch case NonFatal(error) => Future.failed(error)
        running.onComplete(onEnd)(using materializer.executionContext)

      setHandlers(in, out, this)

object Steer:
  /** Maximum number of events that wait for downstream; at this number no more commands are taken. */
  val EventLimit = 64

  /** Pause before parking a vehicle is attempted again. */
  val ParkAgain: Span = Span.ofMillis(100)

  /** Maximum number of attempts to park a vehicle at the end. */
  val LastAttempts = 10

  private case object Later
