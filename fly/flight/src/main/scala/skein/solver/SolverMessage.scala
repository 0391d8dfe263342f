package skein.solver

import skein.loop.{Chosen, Memory, TeamView}
import skein.policy.Fleet
import skein.record.{ClockKind, FlightRow, ParameterRow, Recording, RecordingHeader, Simulator}
import skein.scenario.Scenarios
import skein.settings.{FlightPlan, FlySettings, RecordedPlan}
import skein.signal.LatencyProfile
import skein.units.*

/** A message between a flight and a solver. Instants are on the controller's clock, unless they are marked as
  * the solver's. Flights and starts of solvers have identifiers that are unique at a solver.
  */
enum SolverMessage:
  /** A flight requests a solver's decisions. */
  case Hello(flight: Long, build: String, briefing: Briefing)

  /** The solver prepares to decide for the flight, and will accept or refuse it. */
  case Preparing(flight: Long)

  /** The solver decides for the flight from now on.
    *
    * candidates are tried
    */
  case Welcome(flight: Long, solver: Long)

  /** The solver refuses the flight, and states why. */
  case Refused(flight: Long, reason: String)

  /** A request was received from a flight that this solver has not accepted: the flight must say hello. */
  case Unknown(flight: Long)

  case Ask(question: Question)

  case Tell(answer: Answer)

  /** The flight has ended; no further requests follow. */
  case Goodbye(flight: Long)

/** The data of a flight that a solver needs: the header of its recording, as far as it concerns decisions.
  *
  * @param parameters parameters as in a recording
  * @param agents each vehicle and its policy, one line each: equal agents give equal lines in every program
  */
final case class Briefing(
    scenario: String,
    loop: String,
    seed: Long,
    period: Span,
    duration: Span,
    parameters: Vector[(String, String)],
    agents: Vector[String]
)

object Briefing:
  def of(settings: FlySettings, plan: FlightPlan): Briefing = Briefing(
    settings.scenario.name,
    plan.loop.label,
    plan.seed,
    settings.period,
    settings.duration,
    RecordedPlan.parameters(settings, plan.copy(link = LatencyProfile.none)).toVector.map(one =>
      (one.name, one.value)
    ),
    agents(plan.fleet(settings))
  )

  /** The flight's plan, by the scenarios and policies of this program.
    *
    * @return Left says what is not known here
    */
  def plan(briefing: Briefing)(using Scenarios): Either[String, RecordedPlan] =
    val flight = FlightRow(
      "solver",
      briefing.loop,
      LatencyProfile.none.name,
      briefing.seed,
      briefing.period,
      briefing.duration,
      ClockKind.Real.label,
      Simulator.Other(""),
      briefing.scenario,
      "",
      Instant.Epoch
    )
    val parameters = briefing.parameters.map((name, value) => ParameterRow(name, value))
    RecordedPlan.of(Recording(RecordingHeader(flight, Nil, parameters)))

  /** A line for each vehicle, without details that differ between processes. */
  def agents(fleet: Fleet): Vector[String] = fleet.agents.map: agent =>
    val start  = agent.startPositionNed
    val policy = s"${agent.policy}".replaceAll("@[0-9a-f]+", "")
    val shown  =
      if policy.length <= MostShown then policy else s"${policy.take(MostShown)}… ${policy.hashCode}"
    s"${agent.name}, ${agent.role}, from ${start.x} ${start.y} " +
      s"${start.z} at ${agent.speed.value} m/s by $shown"

  private val MostShown = 400

/** A request for decisions.
  *
  * @param deciders the vehicles to decide for, at least one: by their indices, with the state that decisions
  *   depend on; the policy's own memory is held by the solver
  * @param number counts the requests for these vehicles; a later one replaces all earlier ones
  * @param solverClock the start of a solver whose clock is known, and the controller's clock minus the
  *   solver's
  * @param remembered the last answer that was used, by the solver's start and the request; absent before the
  *   first
  * @param view without its forecast, and with sensors of these vehicles only
  */
final case class Question(
    flight: Long,
    deciders: Vector[(vehicle: Int, memory: Memory)],
    number: Long,
    askedAt: Instant,
    solverClock: Option[(solver: Long, offset: Span)],
    remembered: Option[(solver: Long, question: Long)],
    view: TeamView
):
  /** The first of its vehicles, which identifies the group. */
  def vehicle: Int = deciders.head.vehicle

/** An answer to a request.
  *
  * @param vehicle the first vehicle of the request
  * @param solver this start of the solver
  * @param takenAt when the request was received, on the solver's clock
  * @param answeredAt when the answer was sent, on the solver's clock
  * @param overtaken number of this flight's requests so far that were skipped for a newer one
  * @param repeated number of this flight's requests so far that were received more than once
  * @param result the decision, or why there is none
  */
final case class Answer(
    flight: Long,
    vehicle: Int,
    number: Long,
    solver: Long,
    takenAt: Instant,
    answeredAt: Instant,
    overtaken: Long,
    repeated: Long,
    result: Either[String, Choice]
)

/** A solver's decision.
  *
  * @param decidedAt the present time as the policy assumed it
  * @param begunAnew whether the memory of earlier decisions was not available
  * @param chosen the decision for each requested vehicle
  */
final case class Choice(
    decidedAt: Instant,
    begunAnew: Boolean,
    chosen: Vector[Chosen]
)
