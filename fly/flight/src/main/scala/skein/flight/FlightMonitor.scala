package skein.flight

import java.util.concurrent.atomic.AtomicLong
import scala.concurrent.Future
import skein.record.*
import skein.units.*

/** Records as `recorder` does, and remembers what is newest for whoever watches the flight. */
final class FlightMonitor(recorder: Recorder) extends Recorder:
  @volatile private var newest: Option[DecisionRow] = None
  private val heard                                 = AtomicLong(Long.MinValue)
  @volatile private var lastBroken                  = Option.empty[Event]
  @volatile private var isOfTeams                   = false

  def offer(record: Record): Unit =
    record match
      case decision: DecisionRow => newest = Some(decision)
      case reading: ReadingRow   => val _ = heard.accumulateAndGet(reading.state.receivedAt.toNanos, math.max)
      case event: Event if event.kind == EventKind.Disconnected => lastBroken = Some(event)
      case _: Sighting                                          => isOfTeams = true
      case _                                                    => ()
    recorder.offer(record)

  def failure: Future[RecordError]                  = recorder.failure
  def close(): Future[Either[RecordError, Written]] = recorder.close()

  /** When the newest reading came, by the controller's clock. */
  def heardAt: Option[Instant] = Some(heard.get).filter(_ != Long.MinValue).map(Instant.ofNanos)

  /** When and why a connection was lost last, or could not be opened. */
  def broken: Option[Event] = lastBroken

  /** Distance between a vehicle and its opponent at the newest decision, unless that regards others, too; and
    * how old the newest reading is now.
    */
  def lastSeen(now: Instant): Option[LastSeen] =
    for
      decision <- newest
      heard    <- heardAt
    yield
      // From when physics was sampled until the reading came.
      val underWay = decision.trueAge.fold(Span.Zero)(_.own - decision.observations.ownAge)
      val apart    =
        decision.own.state.value.positionNed.horizontalDistance(decision.opponent.state.value.positionNed)
      LastSeen(Option.unless(isOfTeams)(Metres(apart)), now.since(heard) + underWay)

/** What is known of a flight, in two numbers. */
final case class LastSeen(distance: Option[Metres], age: Span)
