package skein.loop

import scala.util.{Failure, Success, Try}
import skein.flow.{Overrun, Steered, Verified}
import skein.policy.Fleet
import skein.port.VehicleError
import skein.record.{
  Acknowledgement,
  CommandOutcome,
  Event,
  EventKind,
  EventSubject,
  LaterDecision,
  LaterRow,
  Planned,
  Prediction,
  Recorder,
  SolverClock,
  SolvedRow
}
import skein.units.*

/** Records the events of a team in flight. */
final class TeamLog(fleet: Fleet, deciders: IndexedSeq[Decider], clock: Clock, recorder: Recorder):
  private val rows = Rows(fleet)

  def note(
      kind: EventKind,
      vehicle: Option[Int],
      detail: String,
      decision: Option[Long] = None,
      about: Option[EventSubject] = None
  ): Unit = recorder.offer(Event(clock.now(), kind, vehicle.map(name), detail, decision, about))

  /** A policy missed its deadline.
    *
    * @param instead sequence number of the fallback's decision, if it made one
    */
  def missed(vehicle: Int, miss: Overrun, instead: Option[Long]): Unit =
    val done = instead.fold("nothing decided")(sequence => s"decision $sequence by the fallback")
    note(EventKind.DeadlineMissed, Some(vehicle), s"$done: $miss", instead)

  /** A solver's decision was received in time. */
  def solved(decision: Decision, by: Solved): Unit =
    import decision.{sequence, vehicle}
    if by.begunAnew then
      val what = s"decision $sequence by a policy that remembers nothing"
      note(EventKind.SolverRestarted, Some(vehicle), what, Some(sequence))
    recorder.offer(
      SolvedRow(
        name(vehicle),
        sequence,
        by.question,
        by.askedAt,
        by.receivedAt,
        by.thinking,
        by.clock.map(known => SolverClock(known.offset, known.uncertainty))
      )
    )

  /** Records why a call failed.
    *
    * @param what the call
    */
  def failed(vehicle: Int, what: String, error: VehicleError, about: Option[EventSubject] = None): Unit =
    note(TeamLog.kindOf(error), Some(vehicle), s"$what: ${error.message}", about = about)

  /** A request for a vehicle's position was not answered.
    *
    * @param sequence sequence of the request
    */
  def unread(vehicle: Int, sequence: Long, error: VehicleError): Unit =
    failed(vehicle, s"reading $sequence", error, Some(EventSubject.Reading))

  def read(reading: Reading): Unit = recorder.offer(rows.reading(reading))

  def sensed(reading: SensorReading): Unit = recorder.offer(rows.measurement(reading))

  /** The error of a prediction by one vehicle's controller. */
  def predicted(decider: Int, verified: Verified): Unit =
    recorder.offer(
      Prediction(
        decider = name(decider),
        vehicle = name(verified.vehicle),
        madeAt = verified.madeAt,
        predictedFor = verified.estimate.predictedFor,
        age = verified.estimate.age,
        positionNed = verified.estimate.kinematics.positionNed,
        error = verified.error
      )
    )

  def decided(decision: Decision): Unit = decided(decision, deciders(decision.vehicle).regardsTeam)

  /** A planned decision, with its plan and inputs. */
  def planned(decision: Decision, plan: PlanReport, regardsTeam: Boolean): Unit =
    import decision.vehicle
    decided(decision, regardsTeam)
    recorder.offer(
      Planned(
        name(vehicle),
        decision.sequence,
        plan.candidates,
        plan.slices.map(_.toLong),
        plan.cost,
        clock.now().since(decision.decidedAt),
        plan.breaches,
        plan.course,
        rows.plannedStates(decision)
      )
    )
    if !plan.isSearched then
      val instead = if plan.byPolicy then "the policy decides" else "the last plan goes on"
      note(EventKind.DeadlineMissed, Some(vehicle), s"no slice was searched: $instead")
    for breach <- plan.breach do
      note(EventKind.LimitBroken, Some(vehicle), s"in the plan of decision ${decision.sequence}: $breach")

  /** Records a decision with its inputs.
    *
    * @param regardsTeam whether the policy observes the other vehicles
    */
  def decided(decision: Decision, regardsTeam: Boolean): Unit =
    val others = if regardsTeam then rows.sighted(decision) else Vector.empty
    recorder.offer(LaterDecision(
      name(decision.vehicle),
      decision.decidedAt,
      decision.action,
      seesOthers = others.nonEmpty,
      decision.view.asRead(decision.decidedAt),
      rows.decision(decision)
    ))
    for other <- others do recorder.offer(LaterRow(rows.sighting(decision, other)))
    for sensed <- rows.sensed(decision) do recorder.offer(LaterRow(rows.sensing(decision, sensed)))

  def steered(steering: SteeringEvent): Unit = steering.event match
    case Steered.Sent(decision, at)          => sent(decision, at)
    case Steered.Ended(decision, at, result) => ended(decision, at, result)

  def sent(decision: Decision, at: Instant): Unit = recorder.offer(rows.command(decision, at))

  def ended(decision: Decision, at: Instant, result: Try[Either[VehicleError, Boolean]]): Unit =
    val outcome = result match
      case Success(Right(true))  => CommandOutcome.Done
      case Success(Right(false)) => CommandOutcome.Superseded
      case Success(Left(error))  =>
        failed(decision.vehicle, s"command ${decision.sequence}", error)
        CommandOutcome.Failed(error.message)
      case Failure(error) => CommandOutcome.Failed(error.toString)
    recorder.offer(Acknowledgement(name(decision.vehicle), decision.sequence, at, outcome))

  private def name(vehicle: Int): String = rows.name(vehicle)

object TeamLog:
  /** The sequence in the detail of an event by [[TeamLog.unread]]. */
  private[skein] def unreadNumber(detail: String): Option[Long] = detail match
    case s"reading $sequence: $_" => sequence.toLongOption
    case _                        => None

  private def kindOf(error: VehicleError): EventKind = error match
    case VehicleError.TimedOut(_)                              => EventKind.TimedOut
    case VehicleError.Lost(_, _) | VehicleError.Unreachable(_) => EventKind.Disconnected
    case VehicleError.Overloaded(_)                            => EventKind.Overloaded
    case VehicleError.Cancelled(_)                             => EventKind.Cancelled
    case VehicleError.Refused(_) | VehicleError.Malformed(_) | VehicleError.Unsupported(_) =>
      EventKind.Refused
