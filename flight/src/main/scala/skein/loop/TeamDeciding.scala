package skein.loop

import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.dispatch.Dispatchers
import org.apache.pekko.stream.scaladsl.Flow
import scala.concurrent.{ExecutionContext, Future}
import skein.flow.*
import skein.loop.planning.{PlanStage, PlanWorkers}
import skein.policy.{AgentPolicy, Fleet, Policy}
import skein.units.*

/** Carries a team's requests forward to when its commands act, decides or plans upon them, and records the decisions.
  *
  * @param deciders
  *   by vehicle
  * @param solver
  *   decides in the policies' place
  */
private final class TeamDeciding(
    fleet: Fleet,
    clock: Clock,
    settings: LoopSettings,
    deciders: IndexedSeq[Decider],
    workers: PlanWorkers,
    solver: Option[Solver],
    sensing: TeamSensing,
    parts: TeamParts,
    log: TeamLog
)(using ExecutionContext):
  @volatile private var underWay = Option.empty[(vehicle: Int, at: Instant)]

  /** For whom a policy is asked, which its loop waits for, and since when. */
  def underDecision: Option[(vehicle: String, since: Instant)] =
    underWay.map(now => (fleet.agents(now.vehicle).name, now.at))

  /** Carries the requests that are meant for one vehicle forward to when its command will act, and records how earlier
    * predictions turned out.
    */
  def predict(vehicle: Int): Flow[DecisionRequest, DecisionRequest, NotUsed] =
    Flow[DecisionRequest]
      .collect { case request if request.deciders(vehicle) => request }
      .via(predicted(Vector(vehicle), solver.fold(Span.Zero)(_.delay), parts.meter("predict", vehicle)))
      .addAttributes(parts.named("predict", vehicle))

  /** Carries requests forward to when the commands of some vehicles will act, and records how earlier predictions turned
    * out.
    *
    * @param lead
    *   how much later that is because of what is done with the request
    */
  def predict(deciders: Vector[Int], lead: Span): Flow[DecisionRequest, DecisionRequest, NotUsed] =
    predicted(deciders, lead, parts.meter("predict")).addAttributes(parts.named("predict"))

  private def predicted(
      deciders: Vector[Int],
      lead: => Span,
      meter: StageMeter
  ): Flow[DecisionRequest, DecisionRequest, NotUsed] =
    Flow[DecisionRequest]
      .collect(Function.unlift: request =>
        meter.enter()
        request.view.forecast.map((request, _)))
      .via(Predict.whenActing(clock, vehicle => deciders.exists(verified(_)(vehicle)), lead)(outcome =>
        for decider <- deciders if verified(decider)(outcome.vehicle) do
          log.predicted(decider, outcome)
      ))
      .map: (request, estimates) =>
        meter.pass(sensing.ageOf(request.view))
        request.copy(view = request.view.copy(estimates = Some(estimates)))

  /** Decides for one vehicle on the requests that are meant for it, within the deadline if there is one, and records the
    * decision.
    */
  def decide(vehicle: Int): Flow[DecisionRequest, Decision, NotUsed] =
    decideInTime(vehicle).addAttributes(parts.named("decide", vehicle))

  private def decideInTime(vehicle: Int): Flow[DecisionRequest, Decision, NotUsed] = settings.deadline match
    case None           => decideAtOnce(vehicle)
    case Some(deadline) =>
      Flow
        .fromMaterializer: (materializer, _) =>
          given system: ActorSystem = materializer.system
          val instead               = deadline.otherwise.policy(fleet.agents(vehicle))
          solver match
            case Some(solver) => decideElsewhere(vehicle, deadline.within, instead, solver)
            case None         =>
              val policies = system.dispatchers.lookup(Dispatchers.DefaultBlockingDispatcherId)
              decideWithin(vehicle, deadline.within, instead):
                case (memory, (view, now)) => Future(decideAt(vehicle, memory, view, now))(using policies)
        .mapMaterializedValue(_ => NotUsed)

  private def decideElsewhere(
      vehicle: Int,
      deadline: Span,
      instead: Option[AgentPolicy],
      solver: Solver
  )(using
      ActorSystem
  ): Flow[DecisionRequest, Decision, NotUsed] =
    inTime[Solved](vehicle, deadline, instead, asksAgain = true)((memory, view, now) =>
      val remembered = memory.held match
        case used: Solver.Remembered => Some(used)
        case _                       => None
      solver
        .ask(vehicle, memory, remembered, view, now, now + deadline)
        .map: solved =>
          val (next, decision) =
            deciders(vehicle).decided(memory, view, solved.decidedAt, solved.headingRad, solved.speed)
          (
            next.copy(held = Solver.Remembered(solved.solver, solved.question)),
            decision.copy(action = solved.action),
            solved
          )
    )(log.solved)

  private def decideAtOnce(vehicle: Int): Flow[DecisionRequest, Decision, NotUsed] =
    requests(vehicle)
      .via(Decide.withMemory(start(vehicle)): (memory, seen) =>
        underWay = Some((vehicle, seen._2))
        try decideAt(vehicle, memory, seen._1, seen._2)
        finally underWay = None)
      .via(decided(vehicle))

  /** What one vehicle shall decide upon, and when it was asked. */
  private def requests(vehicle: Int): Flow[DecisionRequest, (TeamView, Instant), NotUsed] =
    val deciding = parts.meter("decide", vehicle)
    // Not `filter`: it fetches one element ahead, which would grow old in it.
    Flow[DecisionRequest].collect:
      case request if request.deciders(vehicle) =>
        deciding.enter()
        (request.view, clock.now())

  private def decided(vehicle: Int): Flow[Decision, Decision, NotUsed] =
    val deciding = parts.meter("decide", vehicle)
    Tap: decision =>
      deciding.pass(sensing.ageOf(decision.view))
      log.decided(decision)

  /** Decides by a policy that takes its time. A deadline missed is recorded.
    *
    * @param instead
    *   decides where the deadline is missed ([[skein.policy.KeepHeading]] repeats the last decision); without it nothing
    *   is sent then, and the vehicle flies on under its last move for as long as that lasts
    * @param policy
    *   from memory, view and the time of asking
    */
  def decideWithin(
      vehicle: Int,
      deadline: Span,
      instead: Option[AgentPolicy]
  )(
      policy: (Memory, (TeamView, Instant)) => Future[(Memory, Decision)]
  )(using ActorSystem): Flow[DecisionRequest, Decision, NotUsed] =
    inTime[Unit](vehicle, deadline, instead, asksAgain = false)((memory, view, now) =>
      policy(memory, (view, now)).map((next, decision) => (next, decision, ()))
    )((_, _) => ())

  /** @param asksAgain
    *   see [[Decide.within]]
    * @param onDecided
    *   told of each decision that came in time, with what came with it
    */
  private def inTime[A](vehicle: Int, deadline: Span, instead: Option[AgentPolicy], asksAgain: Boolean)(
      policy: (Memory, TeamView, Instant) => Future[(Memory, Decision, A)]
  )(onDecided: (Decision, A) => Unit)(using ActorSystem): Flow[DecisionRequest, Decision, NotUsed] =
    type Seen = (TeamView, Instant)
    type Made = (Decision, Option[A])
    val otherwise = instead.fold(OnOverrun.Hold[Memory]()): fallback =>
      val decider = Decider(fleet, vehicle, fallback)
      OnOverrun.Ask[Memory, Seen, Made]: (memory, seen) =>
        val (next, decision) = decider.decideInstead(memory, seen._1, seen._2)
        (next, (decision, None))
    requests(vehicle)
      .via(Decide.within[Memory, Seen, Made](deadline, otherwise, start(vehicle), asksAgain)((memory, seen) =>
        policy(memory, seen._1, seen._2).map((next, decision, came) => (next, (decision, Some(came))))
      ))
      .map:
        case DeadlineResult.Decided((decision, came)) =>
          came.foreach(onDecided(decision, _))
          Some(decision)
        case DeadlineResult.Missed(miss, instead) =>
          val made = instead.map(_._1)
          log.missed(vehicle, miss, made.map(_.sequence))
          made
      .collect { case Some(decision) => decision }
      .via(decided(vehicle))

  /** How the decisions of those vehicles are planned that plan. */
  val planning: Option[JointPlanning] = JointPlanning.of(fleet, settings.planning, settings.seed)

  /** Plans upon each request for all vehicles that plan, and records the decisions and how they were planned. */
  def plan(planning: JointPlanning)(using ActorSystem): Flow[DecisionRequest, Vector[Decision], NotUsed] =
    type Seen = (TeamView, Instant)
    val vehicles = planning.vehicles
    val meter    = parts.meter("plan")
    Flow[DecisionRequest]
      .map: request =>
        meter.enter()
        (request.view, clock.now())
      .via(PlanStage.within(settings.planning.deadline, workers, planning.planner, vehicles.map(start))(
        (memories, seen: Seen) => planning.pose(memories, vehicles.map(_ => seen._1), seen._2),
        (memories, seen: Seen, parts, answer) =>
          val (next, planned) = planning.decide(memories, vehicles.map(_ => seen._1), seen._2, parts, answer)
          (next, (planned, answer))
      ))
      .via(Tap((planned, answer) =>
        meter.pass(planned.headOption.flatMap(one => sensing.ageOf(one.decision.view)))
        for one <- planned do log.planned(one, answer, planning.regardsTeam(one.decision.vehicle))
      ))
      .map((planned, _) => planned.map(_.decision))
      .addAttributes(parts.named("plan"))

  def start(vehicle: Int): Memory = deciders(vehicle).start

  /** The pure decision, for loops that keep their own time. */
  def decideAt(vehicle: Int, memory: Memory, view: TeamView, now: Instant): (Memory, Decision) =
    deciders(vehicle).decide(memory, view, now)

  /** Whose predictions are held against readings by a decider: where each of a team predicts all, its own. */
  private def verified(decider: Int): Int => Boolean = fleet.agents(decider).policy match
    case _: Policy => _ => true
    case _         => _ == decider
