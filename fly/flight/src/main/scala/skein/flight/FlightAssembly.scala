package skein.flight

import org.apache.pekko.Done
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Success
import skein.flow.Hold
import skein.loop.*
import skein.record.*
import skein.settings.FlightPlan
import skein.solver.SolverClient
import skein.units.*

/** An assembled flight: simulator, link, client, vehicles at their starts, loop.
  *
  * @param skipped time that the built-in simulator has skipped, if the flight has one
  */
final class FlightAssembly private[skein] (
    val plan: FlightPlan,
    val flight: Flight,
    val graph: RunningGraph,
    hold: Hold,
    monitor: FlightMonitor,
    watchdog: SimulatorWatchdog,
    startedAt: Instant,
    clock: Clock,
    shutDown: () => Future[Done],
    solver: Option[SolverClient],
    skipped: () => Span
)(using ExecutionContext):

  /** Ends the flight immediately; the reason is recorded. */
  def stop(why: String): Unit =
    monitor.offer(Event(clock.now(), EventKind.Aborted, None, why))
    flight.stop()

  /** Pauses decisions: its vehicles hover until it continues or ends; its time runs on. The user is recorded.
    */
  def pause(who: String): Unit =
    if hold.hold() then monitor.offer(Event(clock.now(), EventKind.Paused, None, who))

  /** Continues a paused flight. The user is recorded. */
  def continue(who: String): Unit =
    if hold.isHeld then
      // Recorded before the first decision that the release allows.
      monitor.offer(Event(clock.now(), EventKind.Continued, None, who))
      hold.release(): Unit

  /** Its progress: in the controller's time, and if time passes in steps, also in the simulator's. */
  def progress: FlightProgress =
    val now = clock.now()
    FlightProgress(
      plan.id,
      now.since(startedAt),
      monitor.lastSeen(now),
      watchdog.silentFor,
      flight.outcome.isCompleted,
      Option.when(isPaused)(monitor.simulated)
    )

  private def isPaused = plan.loop == LoopKind.Paused

  /** Late control threads do not matter while time stands still. */
  private def starved: Option[String] =
    if isPaused then None else watchdog.starved.orElse(Lateness.skipped(skipped()))

  /** Completes when the flight has ended, everything is closed, and all records are written. */
  val landed: Future[FlightResult] =
    for
      flown   <- flight.outcome
      outcome <- if flown == FlightOutcome.Completed then watchdog.last() else Future.successful(flown)
      closed  <- shutDown().transform(Success(_))
      notClosed = closed.failed.toOption.map(error => FlightOutcome.Failed(s"it could not be closed: $error"))
      ended     = notClosed.filter(_ => outcome == FlightOutcome.Completed).getOrElse(outcome)
      _         = starved.foreach(why => monitor.offer(Event(clock.now(), EventKind.Starved, None, why)))
      _         = monitor.offer(FlightAssembly.ending(ended, clock.now()))
      written <- monitor.close()
    yield FlightResult(plan, ended, written, solver.fold(Vector.empty)(_.roundTrips))

private object FlightAssembly:
  def ending(outcome: FlightOutcome, at: Instant): Ending = outcome match
    case FlightOutcome.Completed      => Ending(at, EndingKind.Completed, None)
    case FlightOutcome.Stopped        => Ending(at, EndingKind.Stopped, Some("it was stopped from outside"))
    case FlightOutcome.Failed(reason) => Ending(at, EndingKind.Failed, Some(reason))

/** The end of a flight, with its recording.
  *
  * @param solverTrips the latest round trips to the solver, if there is one
  */
final case class FlightResult(
    plan: FlightPlan,
    outcome: FlightOutcome,
    written: Either[RecordError, Written],
    solverTrips: Vector[Span] = Vector.empty
)
