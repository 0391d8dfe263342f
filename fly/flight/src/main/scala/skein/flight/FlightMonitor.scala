package skein.flight

import java.util.concurrent.atomic.{AtomicLong, AtomicReference}
import scala.concurrent.Future
import skein.policy.Action
import skein.record.*
import skein.signal.{Kinematics, Stamped, TimeAxis}
import skein.units.*

/** Passes records on to `recorder`, and keeps the newest ones for progress displays.
  *
  * @param isStepped whether the simulator stands still between steps, so that its clock is not compared with
  *   the controller's
  * @param hasPlaces whether readings are the vehicles' true positions. Then an implausible displacement shows
  *   that another client placed a vehicle; an autopilot's estimates may jump by themselves
  * @param movesLast duration of the flight's moves, for detecting other clients' moves; absent if the
  *   simulator does not report replaced moves
  */
final class FlightMonitor(
    recorder: Recorder,
    isStepped: Boolean = false,
    hasPlaces: Boolean = false,
    movesLast: Option[Span] = None
) extends Recorder:
  @volatile private var newest     = Option.empty[LaterDecision]
  private val heard                = AtomicLong(Long.MinValue)
  @volatile private var lastBroken = Option.empty[Event]
  @volatile private var isOfTeams  = false

  /** The last answer that arrived after its time-out. */
  @volatile private var lastLate = Option.empty[Event]
  private val clocks             = AtomicReference(TimeAxis.begun)
  private val places             = AtomicReference(Map.empty[String, Stamped[Kinematics]])
  private val landing            = AtomicReference(Set.empty[String])
  private val firstAt            = AtomicLong(Long.MaxValue)
  private val lastAt             = AtomicLong(Long.MinValue)
  private val displaced          = AtomicReference(Option.empty[String])
  private val moves              = AtomicReference(Map.empty[String, ForeignMoves])

  def offer(record: Recordable): Unit =
    record match
      case decision: LaterDecision => decided(decision)
      case reading: ReadingRow     => read(reading)
      case move: CommandRow        => movesLast.foreach(_ => moved(move.vehicle)(_.sent(move)))
      case move: Acknowledgement   => movesLast.foreach(lasts => moved(move.vehicle)(_.ended(move, lasts)))
      case event: Event if event.kind == EventKind.Disconnected => lastBroken = Some(event)
      case event: Event if event.kind == EventKind.LateReply    => lastLate = Some(event)
      case _                                                    => ()
    recorder.offer(record)

  export recorder.{close, failure}

  def late: Option[Event] = lastLate

  private def decided(decision: LaterDecision): Unit =
    newest = Some(decision)
    if decision.seesOthers then isOfTeams = true
    val lands = decision.action == Action.Land
    if lands != isLanding(decision.vehicle) then
      landing.updateAndGet(all => if lands then all + decision.vehicle else all - decision.vehicle): Unit

  private def moved(vehicle: String)(next: ForeignMoves => ForeignMoves): Unit =
    moves.updateAndGet(all => all.updated(vehicle, next(all.getOrElse(vehicle, ForeignMoves())))): Unit

  private def read(reading: ReadingRow): Unit =
    import reading.{state, vehicle}
    heard.accumulateAndGet(state.receivedAt.toNanos, math.max): Unit
    firstAt.accumulateAndGet(state.validAt.toNanos, math.min): Unit
    lastAt.accumulateAndGet(state.validAt.toNanos, math.max): Unit
    if !isStepped then clocks.updateAndGet(_.updated(vehicle, state)): Unit
    if hasPlaces && clocks.get.fault.isEmpty then
      val before = places.getAndUpdate(all =>
        if all.get(vehicle).exists(_.validAt > state.validAt) then all else all.updated(vehicle, state)
      )
      for
        last <- before.get(vehicle)
        why  <- Displacement.between(vehicle, last, state)
      do displaced.compareAndSet(None, Some(why)): Unit

  /** Why the flight cannot have a result, by its readings and the answers to its moves. */
  def unsound: Option[Unsound] =
    clocks.get.fault.map(Unsound(EventKind.ClockBroken, _)).orElse(
      displaced.get.orElse(foreignMoves).map(Unsound(EventKind.VehicleTaken, _))
    )

  private def foreignMoves: Option[String] = moves.get.collectFirst:
    case (vehicle, its) if its.areMany =>
      s"another client moves $vehicle: ${ForeignMoves.Many} of its last ${ForeignMoves.Judged} moves were " +
        "replaced by none of this flight"

  /** Why the simulator's clock does not keep pace at present, if it does not. */
  def wandering: Option[String] = clocks.get.wandering

  /** Whether a vehicle's last command was to land. */
  def isLanding(vehicle: String): Boolean = landing.get.contains(vehicle)

  /** Time elapsed on the simulator's clock since the first reading. */
  def simulated: Span =
    if lastAt.get < firstAt.get then Span.Zero else Span.ofNanos(lastAt.get - firstAt.get)

  /** When the newest reading was received, on the controller's clock. */
  def heardAt: Option[Instant] = Some(heard.get).filter(_ != Long.MinValue).map(Instant.ofNanos)

  /** The last event of a connection that was lost or could not be opened. */
  def broken: Option[Event] = lastBroken

  /** Distance between a vehicle and its opponent at the newest decision, unless the policy also considers
    * other vehicles; and the present age of the newest reading.
    */
  def lastSeen(now: Instant): Option[LastSeen] =
    for
      decision <- newest.map(_.row)
      heard    <- heardAt
    yield
      // From the sampling of physics to the reading's receipt.
      val underWay = decision.trueAge.fold(Span.Zero)(_.own - decision.observations.ownAge)
      val apart    =
        decision.own.state.value.positionNed.horizontalDistance(decision.opponent.state.value.positionNed)
      LastSeen(Option.unless(isOfTeams)(Metres(apart)), now.since(heard) + underWay)

/** Why a flight cannot have a result.
  *
  * @param kind kind of the event that shows it
  */
final case class Unsound(kind: EventKind, why: String)

/** The state of a flight for progress displays. */
final case class LastSeen(distance: Option[Metres], age: Span)
