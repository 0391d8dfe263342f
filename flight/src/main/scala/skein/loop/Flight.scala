package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.{KillSwitches, SharedKillSwitch}
import org.apache.pekko.stream.scaladsl.RunnableGraph
import scala.concurrent.{Future, Promise}
import scala.util.{Failure, Success}
import skein.port.SteppedTime
import skein.record.{EventKind, Recorder}
import skein.units.*

// Recordings name it, too, and so it is theirs.
export skein.record.LoopKind

/** How a flight ended. */
enum Outcome:
  /** It flew its whole time, or its scenario was over. */
  case Completed

  /** Somebody stopped it. */
  case Stopped

  /** It could not go on; the vehicles were told to hover. */
  case Failed(reason: String)

/** A flight under way. Whatever ends it, the vehicles are told to hover and every call has ended when `outcome`
  * completes.
  */
final class Flight private (stopping: Promise[Outcome], val outcome: Future[Outcome]):

  /** How it ends, as soon as that is decided: before the vehicles hover. */
  def ending: Future[Outcome] = stopping.future

  /** Ends the flight now, because it cannot go on. */
  def fail(reason: String): Unit =
    val _ = stopping.trySuccess(Outcome.Failed(reason))

  /** Ends the flight now, since there is nothing more to fly. */
  def complete(): Unit =
    val _ = stopping.trySuccess(Outcome.Completed)

  /** Ends the flight now. */
  def stop(): Unit =
    val _ = stopping.trySuccess(Outcome.Stopped)

object Flight:

  /** Flies a loop for `duration`; for `paused`, of the simulator's time. A failure of the recorder ends the flight.
    *
    * @param time
    *   what lets the simulator's time pass; only `paused` needs it
    * @param onTime
    *   how it has ended when its time is over
    */
  def start(
      kind: LoopKind,
      team: Team,
      time: Option[SteppedTime],
      duration: Span,
      clock: Clock,
      recorder: Recorder,
      onTime: () => Outcome = () => Outcome.Completed
  )(using
      system: ActorSystem
  ): Flight =
    import system.dispatcher
    require(kind != LoopKind.Paused || time.isDefined, "paused needs a simulator whose time passes in steps")
    val switch   = KillSwitches.shared("flight")
    val stopping = Promise[Outcome]()
    val graph    = loop(kind, team, time, duration, clock, switch, () => stopping.isCompleted)
    val running  = graph.run()

    recorder.failure.foreach(error => stopping.trySuccess(Outcome.Failed(error.message)))
    val timer = Option.when(kind != LoopKind.Paused):
      system.scheduler.scheduleOnce(duration.toDuration)(stopping.trySuccess(onTime()): Unit)
    stopping.future.foreach(_ => switch.shutdown())

    val landed = running.transformWith: ended =>
      timer.foreach(_.cancel())
      ended match
        case Success(_) =>
          stopping.trySuccess(onTime())
          stopping.future
        case Failure(error) =>
          val reason = Option(error.getMessage).getOrElse(error.toString)
          stopping.trySuccess(Outcome.Failed(reason))
          team.log.note(EventKind.Aborted, None, reason)
          // `paused` has told them already.
          val hovering = if kind == LoopKind.Paused then Future.unit else team.hoverAll()
          hovering.transformWith(_ => stopping.future)
    Flight(stopping, landed.map(recorded(recorder, _)))

  /** The last answers come after the flight's time is over; where they could not be kept, it has failed all the same. */
  private def recorded(recorder: Recorder, outcome: Outcome): Outcome =
    recorder.failure.value.flatMap(_.toOption) match
      case Some(error) if !outcome.isInstanceOf[Outcome.Failed] => Outcome.Failed(error.message)
      case _                                                    => outcome

  private def loop(
      kind: LoopKind,
      team: Team,
      time: Option[SteppedTime],
      duration: Span,
      clock: Clock,
      switch: SharedKillSwitch,
      stopped: () => Boolean
  )(using system: ActorSystem): RunnableGraph[Future[Done]] =
    import system.dispatcher
    kind match
      case LoopKind.Paused =>
        PausedLoop(team, time.get, duration.toNanos / team.settings.period.toNanos, clock, stopped)
      case LoopKind.Sequential => SequentialLoop(team, switch)
      case LoopKind.Futures    => FuturesLoop(team, switch)
      case LoopKind.Stream     => StreamLoop(team, switch)
      case LoopKind.Predictive => PredictiveLoop(team, switch)
      case LoopKind.Plan       => PlanLoop(team, switch)
