package skein.loop

import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.dispatch.Dispatchers
import org.apache.pekko.stream.scaladsl.Flow
import scala.concurrent.{ExecutionContext, Future}
import skein.flow.*
import skein.loop.planning.{PlanStage, PlanWorkers}
import skein.policy.Policy
import skein.units.*

/** Predicts a team's requests for the time at which their commands take effect, decides or plans on them, and
  * records the decisions.
  *
  * @param deciders the decider of each vehicle
  * @param solver decides instead of the policies
  */
private final class TeamDeciding(
    deciders: IndexedSeq[Decider],
    workers: PlanWorkers,
    solver: Option[Solver],
    sensing: TeamSensing,
    parts: TeamParts
)(using ExecutionContext):
  import parts.{clock, fleet, log, settings}

  /** A view for a decision, with the time of the request. */
  private type Seen = (TeamView, Instant)

  /** The plan is absent if a fallback decided. */
  private type Planned = (decision: Decision, plan: Option[PlanReport])

  private val foresight =
    Foresight(Foreseen(fleet, deciders, settings.period), deciders.map(_.start).toVector)

  @volatile private var underWay = Option.empty[(vehicle: Int, at: Instant)]

  /** The vehicle whose policy the loop waits for, and since when. */
  def underDecision: Option[(vehicle: String, since: Instant)] =
    underWay.map(now => (fleet.agents(now.vehicle).name, now.at))

  /** Predicts the requests for one vehicle to the time at which its command takes effect, and records the
    * errors of earlier predictions.
    */
  def predict(vehicle: Int): Flow[DecisionRequest, DecisionRequest, NotUsed] =
    Flow[DecisionRequest]
      .collect:
        case request if request.deciders(vehicle) => request.copy(view = request.view.of(vehicle))
      .via(predicted(Vector(vehicle), delay, parts.meter("predict", vehicle)))
      .addAttributes(parts.named("predict", vehicle))

  /** Predicts requests to the time at which the commands of some vehicles take effect, and records the errors
    * of earlier predictions.
    *
    * @param lead additional time for planning, here or at a solver
    */
  def predict(deciders: Vector[Int], lead: Span): Flow[DecisionRequest, DecisionRequest, NotUsed] =
    predicted(deciders, lead + delay, parts.meter("predict")).addAttributes(parts.named("predict"))

  private def delay: Span = solver.fold(Span.Zero)(_.delay)

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

  /** Decides for one vehicle on its requests, within the deadline if there is one, and records the decision.
    */
  def decide(vehicle: Int): Flow[DecisionRequest, Decision, NotUsed] =
    decideInTime(vehicle).addAttributes(parts.named("decide", vehicle))

  private def decideInTime(vehicle: Int): Flow[DecisionRequest, Decision, NotUsed] = settings.deadline match
    case None           => decideAtOnce(vehicle)
    case Some(deadline) =>
      Flow
        .fromMaterializer: (materializer, _) =>
          given system: ActorSystem = materializer.system
          solver match
            case Some(solver) => decideElsewhere(vehicle, deadline, solver)
            case None         =>
              val policies = system.dispatchers.lookup(Dispatchers.DefaultBlockingDispatcherId)
              decideWithin(vehicle, deadline.within, deadline.otherwise.policy(fleet.agents(vehicle))):
                case (memory, (view, now)) => Future(decideAt(vehicle, memory, view, now))(using policies)
        .mapMaterializedValue(_ => NotUsed)

  private def decideElsewhere(vehicle: Int, deadline: Deadline, solver: Solver)(using
      ActorSystem
  ): Flow[DecisionRequest, Decision, NotUsed] =
    requests(vehicle)
      .via(askElsewhere(Vector(vehicle), deadline, solver, Span.Zero))
      .map((made, _) => made.head)
      .via(decided(vehicle))

  /** Requests joint decisions from a solver. Answers and missed deadlines are recorded.
    *
    * @return the decisions with the answer; without an answer, the fallback's decisions
    */
  private def askElsewhere(vehicles: Vector[Int], deadline: Deadline, solver: Solver, searching: Span)(using
      ActorSystem
  ): Flow[Seen, (Vector[Decision], Option[Solved]), NotUsed] =
    val instead = Expect.each(vehicles)(vehicle =>
      deadline.otherwise.policy(fleet.agents(vehicle)).toRight(())
    ).toOption
    val answered = inTime(vehicles, deadline.within, instead, asksAgain = true): (memories, view, now) =>
      val remembered = memories.head.held match
        case used: Solver.Remembered => Some(used)
        case _                       => None
      val asked = vehicles.zip(memories).map((vehicle, memory) => (vehicle = vehicle, memory = memory))
      solver
        .ask(asked, remembered, view, now, now + deadline.within, searching)
        .map: solved =>
          val used         = Solver.Remembered(solved.solver, solved.question)
          val (next, made) = asked.zip(solved.chosen).map((asked, chosen) =>
            val (next, decision) =
              deciders(asked.vehicle).decided(asked.memory, view, solved.decidedAt, chosen.action)
            (next.copy(held = used), decision)
          ).unzip
          (next, made, solved)
    answered.via(Tap((made, solved) => for by <- solved; decision <- made do log.solved(decision, by)))

  private def decideAtOnce(vehicle: Int): Flow[DecisionRequest, Decision, NotUsed] =
    requests(vehicle)
      .via(Decide.withMemory(start(vehicle)): (memory, seen) =>
        underWay = Some((vehicle, seen._2))
        try
          val made = decideAt(vehicle, memory, seen._1, seen._2)
          foresight.decided(vehicle, made._1, made._2)
          made
        finally underWay = None)
      .via(decided(vehicle))

  /** Adds to each decision of a vehicle the actions foreseen after it, to be sent in one command. A part of
    * the graph only if the settings enable it.
    */
  def foresee(vehicle: Int): Flow[Decision, Decision, NotUsed] =
    if !settings.planInPacket then Flow[Decision]
    else Flow[Decision].map(foresight.planned).addAttributes(parts.named("foresee", vehicle))

  private def requests(vehicle: Int): Flow[DecisionRequest, Seen, NotUsed] =
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

  /** Decides with a slow policy. A missed deadline is recorded.
    *
    * @param instead decides where the deadline is missed ([[skein.policy.KeepHeading]] repeats the last
    *   decision); without it nothing is sent then, and the vehicle continues its last move until that ends
    * @param policy decides from memory, view and the time of the request
    */
  def decideWithin(
      vehicle: Int,
      deadline: Span,
      instead: Option[Policy]
  )(
      policy: (Memory, (TeamView, Instant)) => Future[(Memory, Decision)]
  )(using ActorSystem): Flow[DecisionRequest, Decision, NotUsed] =
    requests(vehicle)
      .via(inTime(Vector(vehicle), deadline, instead.map(Vector(_)), asksAgain = false)(
        (memories, view, now) =>
          policy(memories.head, (view, now)).map((next, decision) => (Vector(next), Vector(decision), ()))
      ))
      .map((made, _) => made.head)
      .via(decided(vehicle))

  /** Joint decisions within a deadline, with the policy's additional result; without a result, the fallback
    * decides. Missed deadlines are recorded.
    *
    * @param instead the fallback, indexed by vehicle; without one there is no decision where a deadline is
    *   missed
    * @param asksAgain see [[Decide.within]]
    */
  private def inTime[A](
      vehicles: Vector[Int],
      deadline: Span,
      instead: Option[Vector[Policy]],
      asksAgain: Boolean
  )(
      policy: (Vector[Memory], TeamView, Instant) => Future[(Vector[Memory], Vector[Decision], A)]
  )(using ActorSystem): Flow[Seen, (Vector[Decision], Option[A]), NotUsed] =
    type Made = (Vector[Decision], Option[A])
    val otherwise = instead.fold(OnOverrun.Hold[Vector[Memory]]()): fallback =>
      val deciders = vehicles.zip(fallback).map(Decider(fleet, _, _))
      OnOverrun.Ask[Vector[Memory], Seen, Made]: (memories, seen) =>
        val (next, made) = deciders
          .zip(memories)
          .map((decider, memory) => decider.decideInstead(memory, seen._1, seen._2))
          .unzip
        (next, (made, None))
    Flow[Seen]
      .via(Decide.within[Vector[Memory], Seen, Made](deadline, otherwise, vehicles.map(start), asksAgain)(
        (memories, seen) =>
          policy(memories, seen._1, seen._2).map((next, made, came) => (next, (made, Some(came))))
      ))
      .map:
        case DeadlineResult.Decided(made)         => made
        case DeadlineResult.Missed(miss, instead) =>
          val made = instead.fold(Vector.empty[Decision])(_._1)
          for (vehicle, place) <- vehicles.zipWithIndex do
            log.missed(vehicle, miss, made.lift(place).map(_.sequence))
          (made, None)
      .collect { case made if made._1.nonEmpty => made }

  /** The planning of the vehicles that plan.
    *
    * @throws IllegalArgumentException if it does not support their models
    */
  lazy val planning: Option[JointPlanning] =
    JointPlanning.of(fleet, settings).fold(reason => throw IllegalArgumentException(reason), identity)

  /** Plans on each request for all vehicles that plan, and records the decisions with their plans. */
  def plan(planning: JointPlanning)(using ActorSystem): Flow[DecisionRequest, Vector[Decision], NotUsed] =
    val meter = parts.meter("plan")
    Flow[DecisionRequest]
      .map: request =>
        meter.enter()
        (request.view, clock.now())
      .via(solver.zip(settings.deadline) match
        case None                     => planHere(planning)
        case Some((solver, deadline)) => planElsewhere(planning, deadline, solver))
      .via(Tap(made =>
        meter.pass(made.headOption.flatMap(one => sensing.ageOf(one.decision.view)))
        for (decision, plan) <- made do
          val regardsTeam = planning.regardsTeam(decision.vehicle)
          plan.fold(log.decided(decision, regardsTeam))(log.planned(decision, _, regardsTeam))
      ))
      .map(_.map(_.decision))
      .addAttributes(parts.named("plan"))

  private def planHere(planning: JointPlanning)(using ActorSystem): Flow[Seen, Vector[Planned], NotUsed] =
    val vehicles = planning.vehicles
    PlanStage.within(settings.planning.deadline, workers, planning.planner, vehicles.map(start))(
      (memories, seen: Seen) => planning.pose(memories, vehicles.map(_ => seen._1), seen._2),
      (memories, seen: Seen, parts, answer) =>
        val (next, made) = planning.decide(memories, vehicles.map(_ => seen._1), seen._2, parts, answer)
        (next, made.map(one => (decision = one.decision, plan = Some(one.plan))))
    )

  private def planElsewhere(planning: JointPlanning, deadline: Deadline, solver: Solver)(using
      ActorSystem
  ): Flow[Seen, Vector[Planned], NotUsed] =
    askElsewhere(planning.vehicles, deadline, solver, settings.planning.deadline).map: (made, solved) =>
      made.zipWithIndex.map((decision, place) =>
        (decision = decision, plan = solved.flatMap(_.chosen(place).plan))
      )

  def start(vehicle: Int): Memory = deciders(vehicle).start

  /** A pure decision, for loops that keep their own time. */
  def decideAt(vehicle: Int, memory: Memory, view: TeamView, now: Instant): (Memory, Decision) =
    deciders(vehicle).decide(memory, view, now)

  /** The vehicles whose predictions a decider compares with readings: only its own, if each vehicle predicts
    * all.
    */
  private def verified(decider: Int): Int => Boolean =
    if fleet.agents(decider).policy.isAgainstOne then _ => true else _ == decider
