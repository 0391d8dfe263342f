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
  * answers after a broken connection or a silence is not the one that the flight began with.
  *
  * @param isOther asks the simulator that; `Left` where that was not answered, else why it is, if it is
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

  /** How long nothing has come, while the simulator is silent. */
  def silentFor: Option[Span] = life.silentSince.map(clock.now().since(_))

  /** How the flight has ended when its time is over. */
  def onTime: FlightOutcome = silentFor.fold(FlightOutcome.Completed)(lasts =>
    FlightOutcome.Failed(silence(clock.now(), s"the last ${seconds(lasts)}"))
  )

  def over(flight: Flight): Unit =
    val looking =
      system.scheduler.scheduleAtFixedRate(Offset.toDuration, LookEvery.toDuration)(() => look(flight))
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
    recognise(flight, now)

  /** A connection may break without a silence: a simulator can be back before its silence is noticed. */
  private def recognise(flight: Flight, now: Instant): Unit =
    val brokenAt = monitor.broken.fold(startedAt)(_.at)
    val doubted  = brokenAt.max(backAt)
    if !asking && doubted > knownAt && monitor.heardAt.exists(_ > brokenAt) then
      asking = true
      isOther().onComplete: answer =>
        answer match
          case Success(Right(None))      => knownAt = now
          case Success(Right(Some(why))) => flight.fail(why)
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
