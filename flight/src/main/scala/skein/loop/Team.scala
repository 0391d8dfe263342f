package skein.loop

import java.util.concurrent.atomic.{AtomicLongArray, AtomicReference, AtomicReferenceArray}
import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.dispatch.Dispatchers
import org.apache.pekko.stream.{Attributes, Graph, UniformFanInShape, UniformFanOutShape}
import org.apache.pekko.stream.scaladsl.{Broadcast, Flow, Merge, MergePreferred, Sink, Source}
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Success}
import skein.flow.*
import skein.forecast.{Commanded, Evidence, Forecast}
import skein.loop.planning.{PlanStage, PlanWorkers}
import skein.policy.{Action, AgentPolicy, Fleet, Policy}
import skein.port.{VehicleError, VehiclePort}
import skein.record.{EventKind, Recorder}
import skein.signal.{ClockAlignment, Stamped}
import skein.units.*
import skein.vehicle.{Guidance, Setpoint}

/** A scenario and the vehicles that fly it: the operators that every loop is built from, with recording in them.
  *
  * @param solver
  *   decides in the policies' place; the settings then have a deadline
  */
final class Team(
    val fleet: Fleet,
    crafts: Vector[VehiclePort],
    clock: Clock,
    recorder: Recorder,
    val settings: LoopSettings,
    workers: PlanWorkers = PlanWorkers.none,
    solver: Option[Solver] = None
)(using ExecutionContext):
  require(crafts.size == fleet.agents.size, "one craft per agent")
  require(solver.isEmpty || settings.deadline.isDefined, "who is asked elsewhere needs a deadline")
  for missing <- Team.missingSensor(fleet, crafts) do throw IllegalArgumentException(missing)

  val vehicles: Range  = crafts.indices
  private val deciders = vehicles.map(Decider(fleet, _))
  val log: TeamLog     = TeamLog(fleet, deciders, clock, recorder)

  /** While it is held, all vehicles hover and nobody decides; they are still asked where they are. */
  val hold: Hold = Hold()

  @volatile private var underWay = Option.empty[(vehicle: Int, at: Instant)]

  /** For whom a policy is asked, which its loop waits for, and since when. */
  def deciding: Option[(vehicle: String, since: Instant)] =
    underWay.map(now => (fleet.agents(now.vehicle).name, now.at))

  /** What passes the parts of the loop's graph. */
  val meters: StageMeters = StageMeters()

  /** Names a part of the graph. */
  def named(part: String): Attributes = Attributes(meters(part))

  /** Names the part of one vehicle. */
  def named(part: String, vehicle: Int): Attributes = Attributes(meter(part, vehicle))

  private def meter(part: String, vehicle: Int) = meters(s"$part(${fleet.agents(vehicle).name})")

  private val sensing = vehicles.map(meter("sense", _))

  private def ageOf(validAt: Option[Instant]): Option[Span] =
    clocks.get.zip(validAt).map((known, valid) => clock.now().since(known.toController(valid)))

  private def ageOf(view: TeamView): Option[Span] =
    ageOf(view.readings.flatten.map(_.state.validAt).minOption)

  // `futures` asks one vehicle from several threads at once.
  private val asked = AtomicLongArray(crafts.size)

  // Known as answers come, before anything is made of them.
  private val clocks = AtomicReference(Option.empty[ClockAlignment])

  // The newest moves of each vehicle, oldest first: as many as may be unanswered.
  private val moves = AtomicReferenceArray(Array.fill(crafts.size)(Vector.empty[Future[Any]]))

  /** Asks a vehicle where it is; the answer, or the error, is recorded. From any thread. */
  def read(vehicle: Int): Future[Either[VehicleError, Reading]] =
    val sequence = asked.getAndIncrement(vehicle)
    val meter    = sensing(vehicle)
    meter.called()
    crafts(vehicle)
      .read()
      .map:
        case Right(state) =>
          val _ = clocks.updateAndGet(known => Some(known.fold(ClockAlignment.of(state))(_.updated(state))))
          val reading = Reading(vehicle, sequence, state)
          meter.answered()
          meter.pass(ageOf(Some(state.validAt)))
          log.read(reading)
          Right(reading)
        case Left(error) =>
          meter.answered()
          log.failed(vehicle, s"reading $sequence", error)
          Left(error)

  /** Whether one answer tells of a later moment than another, by all that the team's vehicles have told. */
  def isNewer(one: Stamped[?], other: Stamped[?]): Boolean =
    clocks.get.getOrElse(ClockAlignment.of(one)).isNewer(one, other)

  private val sensors = vehicles.toVector.flatMap: vehicle =>
    fleet.agents(vehicle).policy.sensors.toVector.sorted.map: name =>
      TeamSensor(vehicle, name, crafts(vehicle).sensors(name), log)

  /** What the policies' sensors say: for each an own periodic source, which nobody waits for. The vehicles are asked a
    * quarter of a period after they were asked where they are.
    */
  def sensed(start: Instant): Vector[Source[LoopEvent, NotUsed]] = sensors.map: sensor =>
    Sense
      .at[VehicleError, SensorReading, NotUsed](
        ticks(start + settings.period / 4),
        settings.window,
        isNewer = (answered, held) => isNewer(answered.values, held.values)
      )(() => sensor.read())(
        onSkip = _.foreach(reading =>
          log.note(
            EventKind.Dropped,
            Some(sensor.vehicle),
            s"${sensor.name} ${reading.sequence} overtaken"
          )
        ),
        onMissed = ticks =>
          log.note(
            EventKind.Skipped,
            Some(sensor.vehicle),
            s"$ticks ticks of ${sensor.name} missed: window full"
          )
      )
      .map(LoopEvent.Measured(_))

  /** Asks every sensor that a policy reads, one after the other; ends at the first error. */
  def senseAll(): Future[Either[VehicleError, Vector[SensorReading]]] =
    sensors.foldLeft(Future.successful[Either[VehicleError, Vector[SensorReading]]](Right(Vector.empty))):
      (soFar, sensor) =>
        soFar.flatMap:
          case Right(readings) => sensor.read().map(_.map(readings :+ _))
          case error           => Future.successful(error)

  /** Asks all vehicles one after the other, in the scenario's order; ends at the first error. */
  def readAll(): Future[Either[VehicleError, Vector[Reading]]] =
    vehicles.foldLeft(Future.successful[Either[VehicleError, Vector[Reading]]](Right(Vector.empty))):
      (soFar, vehicle) =>
        soFar.flatMap:
          case Right(readings) => read(vehicle).map(_.map(readings :+ _))
          case error           => Future.successful(error)

  /** Events of several sources; before them what was commanded, which ends the loop where it ends. */
  def events(sources: Int): Graph[MergePreferred.MergePreferredShape[LoopEvent], NotUsed] =
    MergePreferred[LoopEvent](sources, eagerComplete = true).addAttributes(named("events"))

  /** Gives every request to all that decide. */
  def cast(deciders: Int =
    vehicles.size): Graph[UniformFanOutShape[DecisionRequest, DecisionRequest], NotUsed] =
    Broadcast[DecisionRequest](deciders).addAttributes(named("cast"))

  /** What became of all vehicles' commands. */
  def steered: Graph[UniformFanInShape[Steering, Steering], NotUsed] =
    Merge[Steering](vehicles.size).addAttributes(named("steered"))

  /** To the recording, back into the loop, and to its end. */
  def fan: Graph[UniformFanOutShape[Steering, Steering], NotUsed] =
    Broadcast[Steering](3).addAttributes(named("fan"))

  /** Joins events to views; emits those on which somebody shall decide. */
  def view: Flow[LoopEvent, DecisionRequest, NotUsed] = viewFrom(TeamView.empty(crafts.size))

  /** The same, with all that a forecast needs. */
  def viewWithForecast: Flow[LoopEvent, DecisionRequest, NotUsed] =
    viewFrom(
      TeamView.empty(crafts.size).copy(forecast = Some(Forecast(vehicles.map(settings.model).toVector)))
    )

  private def viewFrom(start: TeamView): Flow[LoopEvent, DecisionRequest, NotUsed] =
    val meter = meters("view")
    Flow[LoopEvent]
      .statefulMap(() => start)(
        (view, event) =>
          event match
            case LoopEvent.Seen(readings, deciders) =>
              val seen =
                readings.foldLeft(view)(_.withReading(_))
              (seen, request(seen, deciders))
            case LoopEvent.Read(reading) if view.isNews(reading) => (view.withReading(reading), None)
            case LoopEvent.Read(reading)                         =>
              log.note(EventKind.Dropped, Some(reading.vehicle), s"reading ${reading.sequence} is stale")
              (view, None)
            case LoopEvent.Measured(reading) => (view.withSensorReading(reading), None)
            case LoopEvent.Moved(move)       =>
              val command = Commanded(move.decision, guidance(move), move.sentAt)
              (view.withMove(move).withEvidence(Evidence.Sent(move.vehicle, command)), None)
            case LoopEvent.Due(deciders) =>
              (view, request(view, deciders))
            case LoopEvent.Heard(evidence) => (view.withEvidence(evidence), None)
        ,
        _ => None
      )
      .collect:
        case Some(request) =>
          meter.pass(ageOf(request.view))
          request
      .addAttributes(named("view"))

  private def request(view: TeamView, deciders: Set[Int]) =
    Option.when(view.isComplete && !hold.isHeld)(DecisionRequest(view, deciders))

  /** Once a period, in the middle between two questions, everybody is due to decide. */
  def due(start: Instant): Source[LoopEvent, NotUsed] =
    ticks(start + settings.period / 2).map(_ => LoopEvent.Due(vehicles.toSet)).addAttributes(named("due"))

  /** Once a period from an instant on: how many ticks were due since the last. */
  def ticks(first: Instant): Source[Int, NotUsed] =
    Source.fromGraph(Metronome(first, settings.period, clock))

  def now: Instant = clock.now()

  /** Carries the requests that are meant for one vehicle forward to when its command will act, and records how earlier
    * predictions turned out.
    */
  def predict(vehicle: Int): Flow[DecisionRequest, DecisionRequest, NotUsed] =
    Flow[DecisionRequest]
      .collect { case request if request.deciders(vehicle) => request }
      .via(predicted(Vector(vehicle), solver.fold(Span.Zero)(_.delay), meter("predict", vehicle)))
      .addAttributes(named("predict", vehicle))

  /** Carries requests forward to when the commands of some vehicles will act, and records how earlier predictions turned
    * out.
    *
    * @param lead
    *   how much later that is because of what is done with the request
    */
  def predict(deciders: Vector[Int], lead: Span): Flow[DecisionRequest, DecisionRequest, NotUsed] =
    predicted(deciders, lead, meters("predict")).addAttributes(named("predict"))

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
        meter.pass(ageOf(request.view))
        request.copy(view = request.view.copy(estimates = Some(estimates)))

  /** Decides for one vehicle on the requests that are meant for it, within the deadline if there is one, and records the
    * decision.
    */
  def decide(vehicle: Int): Flow[DecisionRequest, Decision, NotUsed] =
    decideInTime(vehicle).addAttributes(named("decide", vehicle))

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
    val deciding = meter("decide", vehicle)
    // Not `filter`: it fetches one element ahead, which would grow old in it.
    Flow[DecisionRequest].collect:
      case request if request.deciders(vehicle) =>
        deciding.enter()
        (request.view, clock.now())

  private def decided(vehicle: Int): Flow[Decision, Decision, NotUsed] =
    val deciding = meter("decide", vehicle)
    Tap: decision =>
      deciding.pass(ageOf(decision.view))
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
    val meter    = meters("plan")
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
        meter.pass(planned.headOption.flatMap(one => ageOf(one.decision.view)))
        for one <- planned do log.planned(one, answer, planning.regardsTeam(one.decision.vehicle))
      ))
      .map((planned, _) => planned.map(_.decision))
      .addAttributes(named("plan"))

  def start(vehicle: Int): Memory = deciders(vehicle).start

  /** The pure decision, for loops that keep their own time. */
  def decideAt(vehicle: Int, memory: Memory, view: TeamView, now: Instant): (Memory, Decision) =
    deciders(vehicle).decide(memory, view, now)

  /** Paces one vehicle: the newest element, at least an interval after the last. */
  def pace[A](vehicle: Int): Flow[A, A, NotUsed] =
    Flow.fromGraph(Pace[A](settings.paceInterval, clock)(_ =>
      log.note(EventKind.Dropped, Some(vehicle), "replaced before its turn")
    )).addAttributes(named("pace", vehicle))

  /** Keeps the newest decision for a vehicle that cannot be commanded yet. */
  def newest(vehicle: Int): Flow[Decision, Decision, NotUsed] =
    Newest[Decision](decision =>
      log.note(EventKind.Dropped, Some(vehicle), s"command ${decision.sequence} replaced before it was sent")
    ).addAttributes(named("newest", vehicle))

  /** Commands one vehicle; emits what is sent and how it ended.
    *
    * '''Emits when''' a command is sent or has ended. '''Backpressures when''' [[Steer]] does. '''Completes when'''
    * upstream has completed, the vehicle was told to hover, and every command has ended. '''Cancels when''' downstream
    * cancels.
    */
  def steer(vehicle: Int): Flow[Decision, Steering, NotUsed] =
    val meter = this.meter("steer", vehicle)
    Flow
      .fromGraph(
        Steer[Decision, Either[VehicleError, Boolean]](
          settings.minCommandInterval,
          clock,
          settings.movesInFlight
        )(
          move(_),
          () => crafts(vehicle).hover(),
          Team.isCertain,
          decision =>
            log.note(
              EventKind.Dropped,
              Some(vehicle),
              s"command ${decision.sequence} not sent ${
                  if hold.isHeld then "while the flight is paused" else "before the end"
                }"
            ),
          hold
        )
      )
      .map: event =>
        count(meter, event)
        Steering(vehicle, event)
      .addAttributes(named("steer", vehicle))

  private def count(steering: StageMeter, event: Steered[Decision, Either[VehicleError, Boolean]]): Unit =
    event match
      case Steered.Sent(decision, _) =>
        steering.called()
        steering.pass(ageOf(decision.view))
      case Steered.Ended(_, _, _) =>
        steering.answered()
        steering.pass()

  /** Takes down every command and how it ended. Never backpressures. */
  def record: Sink[Steering, ?] = Sink.foreach(log.steered).addAttributes(named("record"))

  /** The moves sent. */
  def sent: Flow[Steering, Move, NotUsed] =
    val meter = meters("sent")
    Flow[Steering]
      .collect:
        case Steering(_, Steered.Sent(decision, at)) =>
          meter.pass()
          decision.move(at)
      .addAttributes(named("sent"))

  /** What a forecast can tell by commands: the moves sent, and those of which the end is news. */
  def told: Flow[Steering, LoopEvent, NotUsed] = Flow[Steering].collect(Function.unlift:
    case Steering(_, Steered.Sent(decision, at)) => Some(LoopEvent.Moved(decision.move(at)))
    case Steering(vehicle, Steered.Ended(decision, at, Success(Right(false)))) =>
      Some(LoopEvent.Heard(Evidence.Replaced(vehicle, decision.sequence, at)))
    case Steering(_, Steered.Ended(_, _, Success(Right(true)))) => None
    case Steering(vehicle, Steered.Ended(decision, _, _))       =>
      Some(LoopEvent.Heard(Evidence.Failed(vehicle, decision.sequence))))

  /** Carries the newest move of each vehicle back into the view. */
  def feedBack: Flow[Move, LoopEvent, NotUsed] =
    Flow[Move]
      .map(move => (move.vehicle, move))
      .via(FeedBack.newest)
      .map((_, move) => LoopEvent.Moved(move))
      .addAttributes(named("feed back"))

  /** Carries events back into the view, the newest of each vehicle and kind. */
  def feedBackAll: Flow[LoopEvent, LoopEvent, NotUsed] =
    Flow[LoopEvent]
      .map:
        case event @ LoopEvent.Moved(move)     => ((event.ordinal, move.vehicle), event)
        case event @ LoopEvent.Heard(evidence) => ((event.ordinal, evidence.vehicle), event)
        case event                             => ((event.ordinal, -1), event)
      .via(FeedBack.newest)
      .map(_._2)
      .addAttributes(named("feed back"))

  /** Sends what was decided; the answer comes when the move ends. */
  def move(decision: Decision): Future[Either[VehicleError, Boolean]] =
    import decision.vehicle
    val answer = crafts(vehicle).act(action(decision), settings.moveDuration)
    val _ = moves.updateAndGet(vehicle, sent => (sent :+ answer).takeRight(settings.movesInFlight.max(2)))
    answer

  /** Tells every vehicle to hover, up to [[UntilCertain.Attempts]] times, once nothing else commands it; one that never
    * says that it does is noted. Ends when every move has been answered, too.
    */
  def hoverAll()(using ActorSystem): Future[Unit] =
    Future.traverse(vehicles.toVector)(hover).map(_ => ())

  private def hover(vehicle: Int)(using ActorSystem): Future[Unit] =
    val sent = moves.get(vehicle)
    for
      // To hover is a command, too, and must not be a third one outstanding.
      _      <- allEnded(sent.dropRight(1))
      answer <- UntilCertain(crafts(vehicle).hover())(Team.isHovering).transform(Success(_))
      _      <- allEnded(sent)
    yield answer match
      case Success(Left(error)) if !Team.isHovering(Left(error)) =>
        log.failed(vehicle, "not known to hover", error)
      case Success(_)     => ()
      case Failure(error) => log.note(EventKind.Aborted, Some(vehicle), s"not known to hover: $error")

  private def allEnded(calls: Vector[Future[Any]]): Future[Unit] =
    Future.traverse(calls)(_.transform(_ => Success(()))).map(_ => ())

  private def guidance(move: Move): Guidance =
    move.action.fold {
      val velocity = fleet.agents(move.vehicle).velocityNed(move.headingRad, move.speed)
      Setpoint.velocityZ(velocity.x, velocity.y, altitude(move.vehicle).value)
    }(Acting.guidance)

  private def action(decision: Decision): Action =
    decision.action.getOrElse:
      import decision.vehicle
      val velocity = fleet.agents(vehicle).velocityNed(decision.heading.value, decision.speed)
      Action.VelocityAt(velocity.x, velocity.y, altitude(vehicle))

  /** Whose predictions are held against readings by a decider: where each of a team predicts all, its own. */
  private def verified(decider: Int): Int => Boolean = fleet.agents(decider).policy match
    case _: Policy => _ => true
    case _         => _ == decider

  private def altitude(vehicle: Int): Metres = Metres(fleet.agents(vehicle).startPositionNed.z)

object Team:

  /** A sensor that a policy asks for and its vehicle has not got, as a line for a person. */
  private[skein] def missingSensor(fleet: Fleet, vehicles: Vector[VehiclePort]): Option[String] =
    fleet.agents.lazyZip(vehicles).flatMap((agent, vehicle) =>
      agent.policy.sensors.toVector.sorted.filterNot(vehicle.sensors.contains).map: name =>
        val known = vehicle.sensors.keys.toVector.sorted
        val has   = if known.isEmpty then "it has none" else s"expected one of ${known.mkString(", ")}"
        s"the policy of ${agent.name} reads a sensor '$name' that the vehicle does not have: $has"
    ).headOption

  /** Whether a call's result says that the call neither runs nor is on its way. */
  private def isCertain(result: Either[VehicleError, Boolean]): Boolean = result.fold(_.isCertain, _ => true)

  /** Whether a vehicle took the command to hover, or refused it. */
  private def isHovering(result: Either[VehicleError, Boolean]): Boolean = result match
    case Right(_) | Left(_: VehicleError.Refused) => true
    case Left(_)                                  => false
