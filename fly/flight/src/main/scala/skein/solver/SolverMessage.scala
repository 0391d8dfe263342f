package skein.solver

import skein.loop.{Chosen, Memory, TeamView}
import skein.policy.Fleet
import skein.record.{ClockKind, FlightRow, ParameterRow, Recording, RecordingHeader, Simulator}
import skein.scenario.Scenarios
import skein.settings.{FlightPlan, FlySettings, RecordedPlan}
import skein.signal.LatencyProfile
import skein.units.*

/** What crosses between a flight and a solver. Instants are the controller's, unless they say that they are
  * the solver's. A flight is named by a number that no other flight at the same solver has, and so is each
  * start of a solver.
  */
enum SolverMessage:
  /** A flight would like to be decided for. */
  case Hello(flight: Long, build: String, briefing: Briefing)

  /** The solver prepares to decide for the flight, and will welcome or refuse it. */
  case Preparing(flight: Long)

  /** The flight is decided for from now on.
    *
    * @param byVectors whether what it plans is searched by the JDK's vectors: else some fifty times fewer
    *   candidates are tried
    */
  case Welcome(flight: Long, solver: Long, byVectors: Boolean)

  /** It is not. */
  case Refused(flight: Long, reason: String)

  /** A question came of a flight that this solver has not welcomed: it is to say hello. */
  case Unknown(flight: Long)

  case Ask(question: Question)

  case Tell(answer: Answer)

  /** The flight has ended. */
  case Goodbye(flight: Long)

/** What a solver is to know of a flight: what its recording begins with, as far as it concerns decisions.
  *
  * @param parameters as a recording has them
  * @param agents who flies by which policy, a line each: two programs that mean the same write the same
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
    RecordedPlan.parameters(settings, plan).toVector.map(one => (one.name, one.value)),
    agents(plan.fleet(settings))
  )

  /** What is flown, by the scenarios and policies of this program.
    *
    * @return or what of it is not known here
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

  /** A line for each vehicle, without what two processes write differently. */
  def agents(fleet: Fleet): Vector[String] = fleet.agents.map: agent =>
    val start  = agent.startPositionNed
    val policy = s"${agent.policy}".replaceAll("@[0-9a-f]+", "")
    val shown  =
      if policy.length <= MostShown then policy else s"${policy.take(MostShown)}… ${policy.hashCode}"
    s"${agent.name}, ${agent.role}, from ${start.x} ${start.y} " +
      s"${start.z} at ${agent.speed.value} m/s by $shown"

  private val MostShown = 400

/** What is to be decided.
  *
  * @param deciders who is decided for, at least one: a vehicle by its place, and what its decisions depend
  *   on; what the policy itself remembers is with the solver
  * @param number counts the questions for these vehicles; a later one leaves all earlier ones
  * @param solverClock of which start of a solver the clock is known, and the controller's clock minus that
  * @param remembered the answer that was used last, by the solver's start and the question; absent before the
  *   first
  * @param view without its forecast, and of sensors with those of these vehicles alone
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
  /** The first of those who are decided for, as which they count. */
  def vehicle: Int = deciders.head.vehicle

/** @param vehicle the first of those who were asked for
  * @param solver this start of it
  * @param takenAt when the question came, on the solver's clock
  * @param answeredAt when the answer left, on the solver's clock
  * @param overtaken questions of this flight so far that were left for a newer one
  * @param repeated questions of this flight so far that came more than once
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

/** @param decidedAt what the policy took for now
  * @param begunAnew whether what was remembered was not there
  * @param chosen for each vehicle that was asked for
  */
final case class Choice(
    decidedAt: Instant,
    begunAnew: Boolean,
    chosen: Vector[Chosen]
)
