package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import scala.util.Success
import skein.forward.Asking
import skein.loop.{Flight, FlightOutcome, UntilCertain}
import skein.record.{Event, EventKind}
import skein.units.*
import skein.units.Decimals.fixed

/** Supervises a flight whose simulator may fall silent: silence is reported and recorded within a second, and
  * so is its end. After [[SimulatorWatchdog.GivesUp]] the flight ends. It also ends if the simulator that
  * answers after a broken connection or a silence is not the original one, if its clock is not a time axis
  * ([[skein.signal.TimeAxis]]), or if another client has taken the vehicles: such a flight has no result. A
  * clock that does not keep pace is reported. The lateness of control's threads is measured too.
  *
  * @param isOther checks whether the simulator is another; `Left` if it did not answer, else the evidence, if
  *   any
  * @param answers requests a sign of life from the simulator over the flight's link
  * @param isShared whether other clients may take the vehicles: then it is checked every
  *   [[SimulatorWatchdog.AskEvery]]
  * @param within time-out of an answer
  * @param deciding the vehicle whose policy the loop waits for, and since when: then the simulator receives
  *   no requests
  * @param tell shows a line to the user
  */
private[flight] final class SimulatorWatchdog(
    monitor: FlightMonitor,
    clock: Clock,
    startedAt: Instant,
    within: Span,
    simulator: String,
    isOther: () => Future[Either[String, Option[String]]],
    answers: () => Future[Boolean],
    isShared: Boolean,
    deciding: () => Option[(vehicle: String, since: Instant)],
    tell: String => Unit
)(using system: ActorSystem):
  import SimulatorWatchdog.*
  import system.dispatcher

  @volatile private var life = SignsOfLife()

  // When the last silence ended, and when the simulator was last known to be the original one.
  @volatile private var backAt, knownAt = startedAt
  @volatile private var asking          = false
  @volatile private var askedAt         = startedAt
  @volatile private var endedSilent     = Option.empty[Span]
  @volatile private var isTold          = false
  @volatile private var wanders         = false
  @volatile private var lateness        = Lateness()

  /** Time since the last answer, while the simulator is silent. */
  def silentFor: Option[Span] = life.silentSince.map(clock.now().since(_))

  /** The outcome of the flight when its time has elapsed, unless [[last]] finds another. A simulator that is
    * silent then must still answer.
    */
  def onTime: FlightOutcome =
    endedSilent = silentFor
    FlightOutcome.Completed

  /** Why the machine was too busy for the flight, if it was. */
  def starved: Option[String] = lateness.starved

  /** The outcome of a flight at its end, after the checks that are still due. */
  def last(): Future[FlightOutcome] = endedSilent match
    case None        => checked()
    case Some(lasts) =>
      // An outage of the link at the end of a flight does not invalidate it; a dead simulator does.
      val asked = UntilCertain(answers(), AttemptsAtEnd, LookEvery)(identity)
      asked.transformWith:
        case Success(true) => checked()
        case _             =>
          val why = silence(clock.now(), s"the last ${seconds(lasts)}")
          tell(s"$why; the vehicles are told to hover")
          Future.successful(FlightOutcome.Failed(why))

  private def checked(): Future[FlightOutcome] =
    val asked =
      if !isShared || monitor.unsound.isDefined then Future.successful(Right(None))
      else isOther().recover { case error => Left(error.toString) }
    asked.map: answer =>
      val why = monitor.unsound.orElse(answer.toOption.flatten.map(Unsound(EventKind.VehicleTaken, _)))
      why.fold(FlightOutcome.Completed): found =>
        tell(found.why)
        isUnsound(found)

  def over(flight: Flight): Unit =
    val begun   = clock.now() + Offset
    var looks   = 0L
    val looking =
      system.scheduler.scheduleAtFixedRate(Offset.toDuration, LookEvery.toDuration): () =>
        lateness = lateness.ticked(clock.now().since(begun + LookEvery * looks))
        looks += 1
        look(flight)
    flight.outcome.onComplete(_ => looking.cancel())
    for case FlightOutcome.Failed(reason) <- flight.ending do tell(s"$reason; the vehicles are told to hover")

  private def look(flight: Flight): Unit =
    val now          = clock.now()
    val (next, sign) = life.look(monitor.heardAt.getOrElse(startedAt), now, within)
    life = next
    sign.foreach:
      case SignsOfLife.Sign.Silent(lasts) =>
        val why = monitor.broken.fold("")(event => s" (${event.detail})")
        note(
          now,
          EventKind.SimulatorSilent,
          silence(now, seconds(lasts)) + why
        )
      case SignsOfLife.Sign.Back(after) =>
        backAt = now
        note(now, EventKind.SimulatorBack, s"the simulator answers again, after ${seconds(after)}")
    if silentFor.exists(_ > GivesUp) then
      flight.fail(silence(now, seconds(GivesUp)))
    monitor.unsound.foreach(found => end(flight, found))
    pace(now)
    recognise(flight, now)

  private def end(flight: Flight, found: Unsound): Unit =
    if !flight.ending.isCompleted then flight.fail(isUnsound(found).reason)

  /** Records why a flight has no result. */
  private def isUnsound(found: Unsound): FlightOutcome.Failed =
    if !isTold then
      isTold = true
      monitor.offer(Event(clock.now(), found.kind, None, found.why))
    FlightOutcome.Failed(found.why)

  /** Reports each time that the clock stops keeping pace. */
  private def pace(now: Instant): Unit =
    val wandering = monitor.wandering
    if !wanders then wandering.foreach(note(now, EventKind.ClockDrift, _))
    wanders = wandering.isDefined

  /** Checks the simulator's identity and custody. A connection may break without a silence: a simulator can
    * be back before its silence is noticed. And another client needs no broken connection to take vehicles.
    */
  private def recognise(flight: Flight, now: Instant): Unit =
    val brokenAt = monitor.broken.fold(startedAt)(_.at)
    val doubted  = brokenAt.max(backAt)
    val isDue    = isShared && now.since(askedAt) >= AskEvery
    if !asking && (isDue || doubted > knownAt && monitor.heardAt.exists(_ > brokenAt)) then
      asking = true
      askedAt = now
      isOther().onComplete: answer =>
        answer match
          case Success(Right(None))      => knownAt = now
          case Success(Right(Some(why))) => end(flight, Unsound(EventKind.VehicleTaken, why))
          case _                         => ()
        asking = false

  private def silence(now: Instant, lasts: String) =
    val late = monitor.late.filter(event => now.since(event.at) < GivesUp).map(_.detail)
    SimulatorWatchdog.silence(simulator, lasts, deciding(), now, late)

  private def note(at: Instant, kind: EventKind, line: String): Unit =
    monitor.offer(Event(at, kind, None, line))
    tell(line)

private[flight] object SimulatorWatchdog:
  /** Time without an answer after which a flight ends. */
  val GivesUp: Span = Span.ofSeconds(10)

  /** Maximum number of attempts to reach a simulator that is silent when the flight's time has elapsed. Each
    * takes a time-out of [[skein.forward.Asking.Timeout]] and a pause: 6 s in all, more than an outage of a
    * second and the waits of TCP after it.
    */
  private val AttemptsAtEnd = 10

  /** Shortest silence that is reported: at ten decisions per second, it is reported within a second of the
    * last answer.
    */
  private val ToldAfter = Span.ofMillis(700)
  private val LookEvery = Span.ofMillis(100)

  /** Interval of checks whether the flight still has its vehicles. */
  val AskEvery: Span = Span.ofSeconds(1)

  /** Time after which a policy that is still deciding is named as the reason why the loop sends no requests.
    */
  private val Slow = Span.ofMillis(200)

  /** Time from a flight's start to the first check, so that checks coincide with no tick. */
  private val Offset = Span.ofMillis(137)

  /** Time without an answer after which the simulator counts as silent: 700 ms, or more with a long period,
    * so that two lost requests in a row do not count as silence.
    */
  def within(period: Span, askTimeout: Span): Span = ToldAfter.max(period * 2 + askTimeout)

  /** The report of a silence: a loop that waits for a policy sends no requests.
    *
    * @param late what answered last after its time-out, if anything did
    */
  def silence(
      simulator: String,
      lasts: String,
      deciding: Option[(vehicle: String, since: Instant)],
      now: Instant,
      late: Option[String] = None
  ): String =
    val why = deciding
      .map(one => (one.vehicle, now.since(one.since)))
      .collect:
        case (vehicle, since) if since > Slow =>
          s": it is not asked while $vehicle's policy has not decided " +
            s"for ${seconds(since)}; --deadline limits that"
    val tardy = late.fold("")(what => s" within the time-out of ${Asking.Timeout.toMillis.round} ms: $what")
    s"no answer from the simulator at $simulator for $lasts$tardy${why.getOrElse("")}"

  private def seconds(span: Span): String = span.toSeconds.fixed(1) + " s"
