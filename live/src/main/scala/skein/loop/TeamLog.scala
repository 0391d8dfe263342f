package skein.loop

import scala.util.{Failure, Success, Try}
import skein.flow.{Plan, Verified}
import skein.link.Clock
import skein.policy.Scenario
import skein.record.*
import skein.rpc.RpcError
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** Tells a recorder what happens to a team in flight. */
final class TeamLog(scenario: Scenario, deciders: IndexedSeq[Decider], clock: Clock, recorder: Recorder):

  def note(kind: EventKind, vehicle: Option[Int], detail: String): Unit =
    recorder.offer(Event(clock.now(), kind, vehicle.map(name), detail))

  /** What a call came to nothing by.
    *
    * @param what
    *   was called
    */
  def failed(vehicle: Int, what: String, error: RpcError): Unit =
    note(TeamLog.kindOf(error), Some(vehicle), s"$what: ${error.message}")

  /** A vehicle told where it is; returns the recorded reading. */
  def read(vehicle: Int, sequence: Long, state: Stamped[Kinematics]): Reading =
    val reading = Reading(sequence, name(vehicle), state)
    recorder.offer(reading)
    reading

  /** How a prediction turned out that one vehicle's controller made. */
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

  /** A decision and what it was made from. */
  def decided(vehicle: Int, decision: Decision, picture: Picture): Unit =
    decided(vehicle, decision, picture, deciders(vehicle).regardsTeam)

  /** A planned decision, how it was planned, and what from. */
  def planned(
      vehicle: Int,
      made: PlannedDecision,
      answer: Plan.Answer,
      picture: Picture,
      regardsTeam: Boolean
  ): Unit =
    val PlannedDecision(decision, action, plan, byPolicy) = made
    decided(vehicle, decision, picture, regardsTeam)
    recorder.offer(
      Planned(
        name(vehicle),
        decision.sequence,
        plan.candidates,
        answer.slices.mkString(","),
        Option.when(plan.cost.isFinite)(plan.cost),
        clock.now().since(decision.decidedAt),
        action.breaches.size
      )
    )
    if plan.slices == 0 then
      val instead = if byPolicy then "the policy decides" else "the last plan goes on"
      note(EventKind.DeadlineMissed, Some(vehicle), s"no slice was searched: $instead")
    for breach <- action.breaches.headOption do
      note(EventKind.LimitBroken, Some(vehicle), s"in the plan of decision ${decision.sequence}: $breach")

  private def decided(vehicle: Int, decision: Decision, picture: Picture, regardsTeam: Boolean): Unit =
    recorder.offer(decision)
    deciders(vehicle).sightings(picture, decision, regardsTeam).foreach(recorder.offer)

  /** A decision went on its way as a command. */
  def sent(vehicle: Int, decision: Decision, at: Instant): Unit =
    val agent    = scenario.agents(vehicle)
    val velocity = agent.velocityNed(decision.heading.value, decision.speed)
    recorder.offer(
      Command(
        decision.sequence,
        agent.name,
        Some(decision.sequence),
        MetresPerSecond(velocity.x),
        MetresPerSecond(velocity.y),
        Metres(agent.startPositionNed.z),
        at
      )
    )

  /** What became of a command. */
  def ended(vehicle: Int, decision: Decision, at: Instant, result: Try[Either[RpcError, Boolean]]): Unit =
    val outcome = result match
      case Success(Right(true))  => "done"
      case Success(Right(false)) => "superseded"
      case Success(Left(error))  =>
        failed(vehicle, s"command ${decision.sequence}", error)
        error.message
      case Failure(error) => error.toString
    recorder.offer(Acknowledgement(name(vehicle), decision.sequence, at, outcome))

  private def name(vehicle: Int): String = scenario.agents(vehicle).name

object TeamLog:
  private def kindOf(error: RpcError): EventKind = error match
    case _: RpcError.Timeout                                 => EventKind.TimedOut
    case _: (RpcError.ConnectionLost | RpcError.Unreachable) => EventKind.Disconnected
    case _: RpcError.Overloaded                              => EventKind.Overloaded
    case _: (RpcError.Refused | RpcError.Malformed)          => EventKind.Refused
    case _: RpcError.Cancelled                               => EventKind.Cancelled
