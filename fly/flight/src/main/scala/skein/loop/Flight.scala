package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.actor.{Actor, ActorSystem, Props}
import org.apache.pekko.stream.{KillSwitches, Materializer, SharedKillSwitch, SystemMaterializer}
import org.apache.pekko.stream.scaladsl.RunnableGraph
import scala.concurrent.{Future, Promise}
import scala.util.Success
import scala.util.control.NonFatal
import skein.port.SteppedTime
import skein.record.{EventKind, Recorder}
import skein.units.*

// Recordings contain loops, too, so the type is defined there.
export skein.record.LoopKind

/** The end of a flight: completed, stopped or failed. */
enum FlightOutcome:
  case Completed

  case Stopped

  /** It could not continue; the vehicles were commanded to hover. */
  case Failed(reason: String)

/** A running flight. However it ends, the vehicles are commanded to hover, and every call has ended when
  * `outcome` completes.
  *
  * @param streams the materializer of its graph, once it runs
  */
final class Flight private (
    stopping: Promise[FlightOutcome],
    val outcome: Future[FlightOutcome],
    private[skein] val streams: Future[Materializer]
):

  /** The outcome as soon as it is decided, before the vehicles hover. */
  def ending: Future[FlightOutcome] = stopping.future

  /** Ends the flight immediately because it cannot continue. */
  def fail(reason: String): Unit =
    val _ = stopping.trySuccess(FlightOutcome.Failed(reason))

  /** Ends the flight immediately, because it is complete. */
  def complete(): Unit =
    val _ = stopping.trySuccess(FlightOutcome.Completed)

  def stop(): Unit =
    val _ = stopping.trySuccess(FlightOutcome.Stopped)

object Flight:

  /** Runs a loop for `duration`; for `paused`, on the simulator's clock. A failure of the recorder ends the
    * flight.
    *
    * @param loop one of Skein's loops, or a user's own
    * @param others the controllers of the other vehicles, if each vehicle has one, in a graph of its own. The
    *   first that ends or fails ends all
    * @param time advances the simulator; only `paused` needs it
    * @param onTime the outcome when its time has elapsed
    * @param on the materializer for one of Skein's loops, by default the system's. A separate one can report
    *   the graph independently: a stream that ends before it answers delays the report of all on its
    *   materializer
    */
  def start(
      loop: AnyLoop,
      team: Team,
      time: Option[SteppedTime],
      duration: Span,
      clock: Clock,
      recorder: Recorder,
      onTime: () => FlightOutcome = () => FlightOutcome.Completed,
      on: Option[Materializer] = None,
      others: Vector[Team] = Vector.empty
  )(using
      system: ActorSystem
  ): Flight =
    import system.dispatcher
    val isPaused = loop == LoopKind.Paused
    require(!isPaused || time.isDefined, "paused needs a simulator whose time passes in steps")
    val switch   = KillSwitches.shared("flight")
    val stopping = Promise[FlightOutcome]()

    def graph(kind: LoopKind, team: Team): RunnableGraph[Future[Done]] = kind match
      case LoopKind.Paused =>
        val steps = duration.toNanos / team.settings.period.toNanos
        PausedLoop(team, time.get, steps, clock, () => stopping.isCompleted)
      case LoopKind.Sequential => SequentialLoop(team, switch)
      case LoopKind.Futures    => FuturesLoop(team, switch)
      case LoopKind.Stream     => StreamLoop(team, switch)
      case LoopKind.Predictive => PredictiveLoop(team, switch)
      case LoopKind.Plan       => PlanLoop(team, switch)
    def run(team: Team) = loop match
      case own: OwnLoop   => runOwn(own, team, switch, stopping.future)
      case kind: LoopKind =>
        val here = on.getOrElse(SystemMaterializer(system).materializer)
        (running = graph(kind, team).run()(using here), streams = Future.successful(here))
    val runs =
      try (team +: others).map(team => (team, run(team)))
      catch
        case NonFatal(failure) =>
          switch.shutdown()
          throw failure

    recorder.failure.foreach(error => stopping.trySuccess(FlightOutcome.Failed(error.message)))
    val timer = Option.when(!isPaused):
      system.scheduler.scheduleOnce(duration.toDuration)(stopping.trySuccess(onTime()): Unit)
    stopping.future.foreach(_ => switch.shutdown())

    def landed(team: Team, running: Future[Done]): Future[Unit] = running.transformWith: ended =>
      timer.foreach(_.cancel())
      val failure = ended.failed.toOption.map(error => Option(error.getMessage).getOrElse(error.toString))
        .map(reason =>
          if others.isEmpty then reason
          else s"the controller of ${team.fleet.agents(team.own.head).name}: $reason"
        )
      stopping.trySuccess(failure.fold(onTime())(FlightOutcome.Failed(_)))
      failure.foreach(team.log.note(EventKind.Aborted, None, _))
      val hovering = loop match
        // These loops have already commanded their vehicles to hover.
        case LoopKind.Paused                => Future.unit
        case _: LoopKind if failure.isEmpty => Future.unit
        case _                              => team.hoverAll()
      hovering.transform(_ => Success(()))
    val allLanded = Future.traverse(runs)((team, graph) => landed(team, graph.running))
    Flight(stopping, allLanded.flatMap(_ => stopping.future).map(recorded(recorder, _)), runs.head._2.streams)

  /** The outcome after the last records. These follow the end of the flight's time; if the recorder failed,
    * so has the flight.
    */
  private def recorded(recorder: Recorder, outcome: FlightOutcome): FlightOutcome =
    recorder.failure.value.flatMap(_.toOption) match
      case Some(error) if !outcome.isInstanceOf[FlightOutcome.Failed] => FlightOutcome.Failed(error.message)
      case _                                                          => outcome

  /** Runs a user's graph. If the graph ignores the kill switch, it is aborted after a time. */
  private def runOwn(
      own: OwnLoop,
      team: Team,
      switch: SharedKillSwitch,
      stopping: Future[FlightOutcome]
  )(using
      system: ActorSystem
  ): (running: Future[Done], streams: Future[Materializer]) =
    import system.dispatcher
    val started   = Promise[Materializer]()
    val brokenOff = Promise[Done]()
    val streams   = system.actorOf(Props(Streams(started)))
    // A graph that cannot be built is a flight that fails: its vehicles hover, and its recording is closed.
    val running = started.future.flatMap(own.graph(team, switch).run()(using _))
    // Its future need not complete when its streams end.
    val ended = Future.firstCompletedOf(Seq(running, brokenOff.future))
    stopping.foreach: _ =>
      val breakingOff = system.scheduler.scheduleOnce(OwnLoop.Grace.toDuration):
        system.stop(streams)
        brokenOff.tryFailure(OwnLoop.BrokenOff(own.name)): Unit
      ended.onComplete(_ => breakingOff.cancel())
    (ended.andThen(_ => system.stop(streams)), started.future)

  /** An actor whose streams end with it. */
  private final class Streams(started: Promise[Materializer]) extends Actor:
    started.success(Materializer(context))
    def receive: Receive = Actor.emptyBehavior
