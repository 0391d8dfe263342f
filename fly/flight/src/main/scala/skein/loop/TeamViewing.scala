package skein.loop

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.{Graph, UniformFanOutShape}
import org.apache.pekko.stream.scaladsl.{Broadcast, Flow, MergePreferred, Source}
import skein.flow.Hold
import skein.forecast.{Commanded, ForecastEvent, Forecast}
import skein.port.CommandPlan
import skein.record.EventKind
import skein.signal.ClockAlignment
import skein.units.*

/** Folds loop events into team views and emits decision requests.
  *
  * @param byMessages whether all vehicles but the controller's own are known by messages
  */
private final class TeamViewing(
    clocks: Option[ClockAlignment],
    byMessages: Boolean,
    hold: Hold,
    sensing: TeamSensing,
    parts: TeamParts
):
  import parts.{fleet, log, own, settings}

  private val vehicles = fleet.agents.indices

  /** Merges events of several sources, with priority for fed-back commands, whose end also ends the loop. */
  def events(sources: Int): Graph[MergePreferred.MergePreferredShape[LoopEvent], NotUsed] =
    MergePreferred[LoopEvent](sources, eagerComplete = true).addAttributes(parts.named("events"))

  def cast(deciders: Int = own.size): Graph[UniformFanOutShape[DecisionRequest, DecisionRequest], NotUsed] =
    Broadcast[DecisionRequest](deciders).addAttributes(parts.named("cast"))

  /** Folds events into views; emits those that need a decision. */
  def view: Flow[LoopEvent, DecisionRequest, NotUsed] = viewFrom(nothingSeen)

  /** [[view]] with all data that a forecast needs. */
  def viewWithForecast: Flow[LoopEvent, DecisionRequest, NotUsed] =
    viewFrom(
      nothingSeen.copy(
        forecast = Some(Forecast(vehicles.map(settings.model).toVector)),
        strangers = Option.when(settings.knows == Knowledge.Positions)(
          Forecast(vehicles.map(vehicle => settings.strangers.model(settings.model(vehicle))).toVector)
        )
      )
    )

  private def nothingSeen =
    TeamView
      .empty(fleet.agents.size)
      .copy(
        alignment = clocks,
        knows = settings.knows,
        byMessages = if byMessages then vehicles.toSet -- own else Set.empty
      )

  private def viewFrom(start: TeamView): Flow[LoopEvent, DecisionRequest, NotUsed] =
    val meter = parts.meter("view")
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
            case LoopEvent.Moved(move, plan) =>
              (view.withMove(move).withEvent(told(move, plan)), None)
            case LoopEvent.Due(deciders) =>
              (view, request(view, deciders))
            case LoopEvent.Heard(event) => (view.withEvent(event), None)
        ,
        _ => None
      )
      .collect:
        case Some(request) =>
          meter.pass(sensing.ageOf(request.view))
          request
      .addAttributes(parts.named("view"))

  private def told(move: SentCommand, plan: Option[CommandPlan]): ForecastEvent = plan match
    case None =>
      val command = Commanded(move.decision, settings.guidance(move.action), move.sentAt)
      ForecastEvent.Sent(move.vehicle, command)
    case Some(plan) =>
      val commands = plan.actions.map: (at, action) =>
        Commanded(move.decision, settings.guidance(action), move.sentAt, actsAt = Some(at))
      ForecastEvent.Planned(move.vehicle, commands)

  private def request(view: TeamView, deciders: Set[Int]) =
    Option.when(view.isComplete && !hold.isHeld)(DecisionRequest(view, deciders))

  /** Emits once a period, half-way between two requests, that its vehicles are due to decide. */
  def due(start: Instant): Source[LoopEvent, NotUsed] =
    sensing.ticks(
      start + settings.period / 2
    ).map(_ => LoopEvent.Due(own.toSet)).addAttributes(parts.named("due"))
