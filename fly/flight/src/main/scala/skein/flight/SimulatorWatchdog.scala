package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import scala.util.Success
import skein.loop.{Flight, FlightOutcome}
import skein.record.{Event, EventKind}
import skein.units.*
import skein.units.Decimals.fixed

/** Watches over a flight whose simulator may fall silent: that is told and recorded within a second, and so
  * is its return. After [[SimulatorWatchdog.GivesUp]] the flight ends. It ends, too, where the simulator that
  * answers after a broken connection or a silence is not the one that the flight began with, where its clock
  * is no time axis ([[skein.signal.TimeAxis]]), or where another client has the vehicles: such a flight has
  * no result. That a clock does not keep pace is told. It also measures how late control's threads run.
  *
  * @param isOther asks the simulator that; `Left` where that was not answered, else why it is, if it is
  * @param isShared whether other clients may take the vehicles: then the simulator is asked every
  *   [[SimulatorWatchdog.AskEvery]]
  * @param within which an answer is to come
  * @param deciding whose policy the loop waits for, and since when: then nobody asks the simulator
  * @param tell a line for a person
  */
private[flight] final class SimulatorWatchdog(
    monitor: FlightMonitor,
    clock: Clock,
    startedAt: Instant,
    within: Span,
    simulator: String,
    isOther: () => Future[Either[String, Option[String]]],
    isShared: Boolean,
    deciding: () => Option[(vehicle: String, since: Instant)],
    tell: String => Unit
)(using system: ActorSystem):
  import SimulatorWatchdog.*
  import system.dispatcher

  @volatile private var life = SignsOfLife()

  // When a silence ended last, and when the simulator was known last to be the one that the flight began
  // with.
  @volatile private var backAt, knownAt = startedAt
  @volatile private var asking          = false
  @volatile private var askedAt         = startedAt
  @volatile private var isTold          = false
  @volatile private var wanders         = false
  @volatile private var lateness        = Lateness()

  /** How long nothing has come, while the simulator is silent. */
  def silentFor: Option[Span] = life.silentSince.map(clock.now().since(_))

  /** How the flight has ended when its time is over. */
  def onTime: FlightOutcome = silentFor.fold(FlightOutcome.Completed)(lasts =>
    FlightOutcome.Failed(silence(clock.now(), s"the last ${seconds(lasts)}"))
  )

  /** That the machine was too busy for the flight, as far as it was watched. */
  def starved: Option[String] = lateness.starved

  /** How a flight has ended that was flown to its end: what nobody has looked at yet is. */
  def last(): Future[FlightOutcome] =
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

  /** Records that a flight has no result. */
  private def isUnsound(found: Unsound): FlightOutcome.Failed =
    if !isTold then
      isTold = true
      monitor.offer(Event(clock.now(), found.kind, None, found.why))
    FlightOutcome.Failed(found.why)

  /** Once each time that it stops to keep pace. */
  private def pace(now: Instant): Unit =
    val wandering = monitor.wandering
    if !wanders then wandering.foreach(note(now, EventKind.ClockDrift, _))
    wanders = wandering.isDefined

  /** A connection may break without a silence: a simulator can be back before its silence is noticed. And
    * another client needs no broken connection to take vehicles away.
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
    SimulatorWatchdog.silence(simulator, lasts, deciding(), now)

  private def note(at: Instant, kind: EventKind, line: String): Unit =
    monitor.offer(Event(at, kind, None, line))
    tell(line)

private[flight] object SimulatorWatchdog:
  /** After so long without an answer a flight ends. */
  val GivesUp: Span = Span.ofSeconds(10)

  /** So that silence is told within a second of the last answer, where decisions are made ten times a second.
    */
  private val ToldAfter = Span.ofMillis(700)
  private val LookEvery = Span.ofMillis(100)

  /** Whether the vehicles are still the flight's. */
  val AskEvery: Span = Span.ofSeconds(1)

  /** So long a policy decides that keeps the loop from asking. */
  private val Slow = Span.ofMillis(200)

  /** From the start of a flight to the first look: at no tick of it. */
  private val Offset = Span.ofMillis(137)

  /** Which an answer is to come: where a flight asks rarely, two questions may be lost. */
  def within(period: Span, askTimeout: Span): Span = ToldAfter.max(period * 2 + askTimeout)

  /** What is told of a silence: a loop that waits for a policy asks no simulator. */
  def silence(
      simulator: String,
      lasts: String,
      deciding: Option[(vehicle: String, since: Instant)],
      now: Instant
  ): String =
    val why = deciding
      .map(one => (one.vehicle, now.since(one.since)))
      .collect:
        case (vehicle, since) if since > Slow =>
          s": it is not asked while $vehicle's policy has not decided " +
            s"for ${seconds(since)}; --deadline limits that"
    s"no answer from the simulator at $simulator for $lasts${why.getOrElse("")}"

  private def seconds(span: Span): String = span.toSeconds.fixed(1) + " s"
