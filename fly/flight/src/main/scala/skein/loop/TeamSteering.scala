package skein.loop

import java.util.concurrent.atomic.AtomicReferenceArray
import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.{Graph, UniformFanInShape, UniformFanOutShape}
import org.apache.pekko.stream.scaladsl.{Broadcast, Flow, Merge, Sink}
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Success}
import skein.flow.*
import skein.forecast.ForecastEvent
import skein.port.{Moves, VehicleError, VehiclePort}
import skein.record.EventKind
import skein.units.*

/** Commands a team's vehicles, records the results, and feeds them back into the loop. */
private final class TeamSteering(
    ports: Vector[VehiclePort],
    hold: Hold,
    sensing: TeamSensing,
    parts: TeamParts
)(using ExecutionContext):
  import parts.{clock, log, own, settings}

  // The newest moves of each vehicle, oldest first: as many as may be unanswered.
  private val moves = AtomicReferenceArray(Array.fill(ports.size)(Vector.empty[Future[Any]]))

  /** Paces one vehicle: emits the newest element, at least an interval after the last. */
  def pace[A](vehicle: Int): Flow[A, A, NotUsed] =
    Flow.fromGraph(Pace[A](settings.paceInterval, clock)(_ =>
      log.note(EventKind.Dropped, Some(vehicle), "replaced before its turn")
    )).addAttributes(parts.named("pace", vehicle))

  /** Keeps the newest decision for a vehicle that cannot be commanded yet. */
  def newest(vehicle: Int): Flow[Decision, Decision, NotUsed] =
    Newest[Decision](decision =>
      log.note(EventKind.Dropped, Some(vehicle), s"command ${decision.sequence} replaced before it was sent")
    ).addAttributes(parts.named("newest", vehicle))

  /** Commands one vehicle; emits the sent commands and their ends.
    *
    * '''Emits when''' a command is sent or has ended. '''Backpressures when''' [[Steer]] does. '''Completes
    * when''' upstream has completed, the vehicle was commanded to hover, and every command has ended.
    * '''Cancels when''' downstream cancels.
    */
  def steer(vehicle: Int): Flow[Decision, SteeringEvent, NotUsed] =
    val meter = parts.meter("steer", vehicle)
    Flow
      .fromGraph(
        Steer[Decision, Either[VehicleError, Boolean]](
          settings.minCommandInterval,
          clock,
          if settings.planInPacket then Moves.MostInFlight else settings.movesInFlight,
          parksInDoubt = !settings.planInPacket
        )(
          move(_),
          () => ports(vehicle).hover(),
          TeamSteering.isCertain,
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
        SteeringEvent(vehicle, event)
      .addAttributes(parts.named("steer", vehicle))

  private def count(steering: StageMeter, event: Steered[Decision, Either[VehicleError, Boolean]]): Unit =
    event match
      case Steered.Sent(decision, _) =>
        steering.called()
        steering.pass(sensing.ageOf(decision.view))
      case Steered.Ended(_, _, _) =>
        steering.answered()
        steering.pass()

  /** Records every command and its end. Never backpressures. */
  def record: Sink[SteeringEvent, ?] = Sink.foreach(log.steered).addAttributes(parts.named("record"))

  def sent: Flow[SteeringEvent, SentCommand, NotUsed] =
    val meter = parts.meter("sent")
    Flow[SteeringEvent]
      .collect:
        case SteeringEvent(_, Steered.Sent(decision, at)) =>
          meter.pass()
          decision.move(at)
      .addAttributes(parts.named("sent"))

  /** Forecast events: commands sent, and command endings that change a prediction. */
  def told: Flow[SteeringEvent, LoopEvent, NotUsed] = Flow[SteeringEvent].collect(Function.unlift:
    case SteeringEvent(_, Steered.Sent(decision, at)) =>
      Some(LoopEvent.Moved(decision.move(at), decision.plan))
    case SteeringEvent(vehicle, Steered.Ended(decision, at, Success(Right(false)))) =>
      Some(LoopEvent.Heard(ForecastEvent.Replaced(vehicle, decision.sequence, at)))
    case SteeringEvent(_, Steered.Ended(_, _, Success(Right(true)))) => None
    case SteeringEvent(vehicle, Steered.Ended(decision, _, _))       =>
      Some(LoopEvent.Heard(ForecastEvent.Failed(vehicle, decision.sequence))))

  /** Feeds the newest move of each vehicle back into the view. */
  def feedBack: Flow[SentCommand, LoopEvent, NotUsed] =
    Flow[SentCommand]
      .map(move => (move.vehicle, move))
      .via(FeedBack.newest)
      .map((_, move) => LoopEvent.Moved(move))
      .addAttributes(parts.named("feed back"))

  /** Feeds events back into the view, the newest of each vehicle and kind. */
  def feedBackAll: Flow[LoopEvent, LoopEvent, NotUsed] =
    Flow[LoopEvent]
      .map:
        case event @ LoopEvent.Moved(move, _) => ((event.ordinal, move.vehicle), event)
        case heard @ LoopEvent.Heard(event)   => ((heard.ordinal, event.vehicle), heard)
        case event                            => ((event.ordinal, -1), event)
      .via(FeedBack.newest)
      .map(_._2)
      .addAttributes(parts.named("feed back"))

  /** Sends a decision as a move; completes when the move ends. */
  def move(decision: Decision): Future[Either[VehicleError, Boolean]] =
    import decision.vehicle
    val answer = decision.plan.fold(
      ports(vehicle).act(decision.performed, settings.moveDuration)
    )(ports(vehicle).follow(_))
    val _ = moves.updateAndGet(vehicle, sent => (sent :+ answer).takeRight(settings.movesInFlight.max(2)))
    answer

  /** Commands its vehicles to hover, up to [[UntilCertain.Attempts]] times, once no other command is pending;
    * records a vehicle that never confirms it. Completes after every move has been answered, too.
    */
  def hoverAll()(using ActorSystem): Future[Unit] =
    Future.traverse(own)(hover).map(_ => ())

  private def hover(vehicle: Int)(using ActorSystem): Future[Unit] =
    val sent = moves.get(vehicle)
    for
      // Hovering is a command, too, and must not be the third unanswered one.
      _      <- allEnded(sent.dropRight(1))
      answer <- UntilCertain(ports(vehicle).hover())(TeamSteering.isHovering).transform(Success(_))
      _      <- allEnded(sent)
    yield answer match
      case Success(Left(error)) if !TeamSteering.isHovering(Left(error)) =>
        log.failed(vehicle, "not known to hover", error)
      case Success(_)     => ()
      case Failure(error) => log.note(EventKind.Aborted, Some(vehicle), s"not known to hover: $error")

  private def allEnded(calls: Vector[Future[Any]]): Future[Unit] =
    Future.traverse(calls)(_.transform(_ => Success(()))).map(_ => ())

  def steered: Graph[UniformFanInShape[SteeringEvent, SteeringEvent], NotUsed] =
    Merge[SteeringEvent](own.size).addAttributes(parts.named("steered"))

  /** Broadcasts to the recording, back into the loop, and to its end. */
  def fan: Graph[UniformFanOutShape[SteeringEvent, SteeringEvent], NotUsed] =
    Broadcast[SteeringEvent](3).addAttributes(parts.named("fan"))

private object TeamSteering:

  /** Whether a call's result means that the call neither runs nor is in transit. */
  private def isCertain(result: Either[VehicleError, Boolean]): Boolean = result.fold(_.isCertain, _ => true)

  /** Whether a vehicle has accepted the command to hover, or refused it. */
  private def isHovering(result: Either[VehicleError, Boolean]): Boolean = result match
    case Right(_) | Left(_: VehicleError.Refused) => true
    case Left(_)                                  => false
