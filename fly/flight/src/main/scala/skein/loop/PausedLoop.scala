package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import scala.concurrent.duration.DurationInt
import skein.port.{SteppedTime, VehicleError}
import skein.record.EventKind
import skein.signal.{Stamped, TimeAxis}
import skein.units.*

/** The paper's model 1, the ground truth: the simulator stands still while every vehicle is read and
  * commanded; then it runs exactly one period. Time is simulated time, so no reading has an age.
  *
  * While time stands still readings do not age, so this loop waits: a request without an answer is repeated
  * for up to [[PausedLoop.Patience]], and a step whose answer is lost is repeated only if the simulator's
  * clock shows that it was not made. After that time the flight ends, since a reference with gaps is none.
  * The length of each step is verified against the simulator's clock; one that took no time, or several
  * periods, ends the flight. However it ends, the simulator runs again and the vehicles are commanded to
  * hover; both are tried up to [[UntilCertain.Attempts]] times. While the team is held, no step begins:
  * nothing moves.
  */
object PausedLoop:

  def apply(team: Team, stepper: SteppedTime, steps: Long, clock: Clock, stopped: () => Boolean)(using
      ActorSystem
  ): RunnableGraph[Future[Done]] =
    val flight = PausedFlight(team, stepper, steps, clock, stopped)
    Source
      .unfoldAsync(flight.start)(flight.next)
      .toMat(Sink.ignore)(Keep.right)
      .mapMaterializedValue(flight.landed)

  /** Time for which a step is retried on the controller's clock, before an error ends the flight: the longest
    * silence allowed to a simulator.
    */
  val Patience: Span = Span.ofSeconds(9)

  /** The valid time of all readings of a step: a single instant, unless the simulator was restarted meanwhile
    * and runs.
    */
  private[loop] def newest(states: Vector[Stamped[?]]): Instant = states.map(_.validAt).max

  /** Inconsistencies in the readings of a step, one line each: time that passed during reading, and a step
    * with a wrong duration.
    *
    * @param before the readings of the previous step; empty if there is none
    */
  private[loop] def drift(
      step: Long,
      before: Vector[Stamped[?]],
      read: Vector[Stamped[?]],
      period: Span
  ): Vector[String] =
    val (now, oldest) = (newest(read), read.map(_.validAt).min)
    val stepped       = Option.when(before.nonEmpty)(now.since(newest(before)))
    Vector(
      Option.when(oldest != now)(
        s"${now.since(oldest).toMillis} ms of simulator time passed " +
          s"while step $step was read: it did not stand still"
      ),
      stepped.filter(_ != period).map(took =>
        s"step $step took ${took.toMillis} ms of simulator time instead of ${period.toMillis} ms"
      )
    ).flatten

  /** The reading with equal times of request and answer: while the simulator stands still, no time passes
    * between them.
    */
  private[loop] def timeless[A](read: Stamped[A]): Stamped[A] =
    read.copy(sentAt = read.validAt, receivedAt = read.validAt)

private final case class PausedStep(number: Long, memories: Vector[Memory], view: TeamView)

/** The state of one flight of [[PausedLoop]]. */
private final class PausedFlight(
    team: Team,
    stepper: SteppedTime,
    steps: Long,
    clock: Clock,
    stopped: () => Boolean
)(using system: ActorSystem):
  import system.dispatcher

  // The moves of the newest step, and those of the one before, which they replace.
  @volatile private var newest, replaced = Vector.empty[Future[Either[VehicleError, Boolean]]]

  val start: PausedStep =
    val nothingSeen = TeamView.empty(team.vehicles.size).copy(knows = team.settings.knows)
    PausedStep(0, team.vehicles.map(team.start).toVector, nothingSeen)

  def next(step: PausedStep): Future[Option[(PausedStep, Done)]] =
    if step.number == steps || stopped() then Future.successful(None)
    else if team.hold.isHeld then
      for
        // So that a simulator's silence is noticed.
        _    <- patiently(team.readAll(isRunning = false))
        next <- after(PausedFlight.LookEvery)(next(step))
      yield next
    else fly(step)

  /** Ends the flight after the last step or an error. The simulator is resumed before the vehicles are
    * commanded to hover: while it stands still, moves that missed their cancellation never end, and those of
    * four vehicles occupy all of its workers.
    */
  def landed(flown: Future[Done]): Future[Done] =
    flown.transformWith: ended =>
      for
        running <- UntilCertain(stepper.resume())(_.isRight)
        _       <- team.hoverAll()
        done    <- running match
          case Right(())                      => Future.fromTry(ended)
          case Left(error) if ended.isSuccess => Future.failed(LoopFailed(standsStill(error)))
          case Left(error)                    =>
            team.log.note(EventKind.Aborted, None, standsStill(error))
            Future.fromTry(ended)
      yield done

  private def fly(step: PausedStep): Future[Option[(PausedStep, Done)]] =
    for
      _        <- if step.number == 0 then patiently(stepper.pause()) else Future.unit
      readings <- patiently(team.readAll(isRunning = false))
      sensed   <- patiently(team.senseAll())
      now  = PausedLoop.newest(readings.map(_.state))
      seen = readings.foldLeft(step.view)((seen, reading) =>
        seen.withReading(reading.copy(state = PausedLoop.timeless(reading.state)))
      )
      view = sensed.foldLeft(seen)((seen, reading) =>
        seen.withSensorReading(reading.copy(values = PausedLoop.timeless(reading.values)))
      )
      _       = verifyStep(step, readings)
      decided =
        team.vehicles.toVector.map(vehicle => team.decideAt(vehicle, step.memories(vehicle), view, now))
      _ = send(decided.map(_._2))
      // A move has reached the simulator when the one that it replaces has ended.
      _ <- Future.traverse(replaced)(orFail)
      _ <- advance(now, clock.now())
    yield
      val moved = decided.foldLeft(view):
        case (seen, (_, decision)) => seen.withMove(decision.move(now))
      Some((PausedStep(step.number + 1, decided.map(_._1), moved), Done))

  private def send(decisions: Vector[Decision]): Unit =
    replaced = newest
    newest = decisions.map: decision =>
      team.log.decided(decision)
      team.log.sent(decision, clock.now())
      team.move(decision).andThen(result => team.log.ended(decision, clock.now(), result))

  /** Runs the simulator for a period from `from`, its present time.
    *
    * @param since when that began, on the controller's clock
    */
  private def advance(from: Instant, since: Instant): Future[Unit] =
    stepper.continueFor(team.settings.period).flatMap:
      case Right(())                             => Future.unit
      case Left(error) if isInVain(error, since) => failed(error)
      case Left(error)                           =>
        team.log.note(EventKind.TimedOut, None, s"a step: ${error.message}")
        for
          at   <- standing(None, since)
          done <- if at.since(from) >= team.settings.period / 2 then Future.unit else advance(from, since)
        yield done

  /** The time at which the simulator stands still, established by two successive readings. Fails if its time
    * runs on.
    */
  private def standing(before: Option[Instant], since: Instant): Future[Instant] =
    for
      _        <- after(PausedFlight.LookEvery)(Future.unit)
      readings <- patiently(team.readAll(isRunning = false), since)
      at = PausedLoop.newest(readings.map(_.state))
      still <-
        if before.contains(at) then Future.successful(at)
        else if before.isDefined && isOver(since) then
          Future.failed(LoopFailed("a step's answer was lost, and the simulator does not stand still"))
        else standing(Some(at), since)
    yield still

  /** Repeats a call until it is answered, or a retry is useless. */
  private def patiently[A](
      call: => Future[Either[VehicleError, A]],
      since: Instant = clock.now()
  ): Future[A] =
    call.flatMap:
      case Right(value)                          => Future.successful(value)
      case Left(error) if isInVain(error, since) => failed(error)
      case Left(_)                               => after(PausedFlight.LookEvery)(patiently(call, since))

  /** Whether a retry cannot help, or the time for retries has elapsed. */
  private def isInVain(error: VehicleError, since: Instant): Boolean = error match
    case VehicleError.Refused(_) | VehicleError.Malformed(_) | VehicleError.Unsupported(_) |
        VehicleError.Cancelled(_) => true
    case _ => isOver(since)

  private def isOver(since: Instant) = stopped() || clock.now().since(since) > PausedLoop.Patience

  private def failed(error: VehicleError) = Future.failed(LoopFailed(error.message))

  /** Fails if the simulator's clock is not a time axis for a flight. */
  private def verifyStep(step: PausedStep, readings: Vector[Reading]): Unit =
    val (before, read) = (step.view.readings.flatten.map(_.state), readings.map(_.state))
    PausedLoop
      .drift(step.number, before, read, team.settings.period)
      .foreach(team.log.note(EventKind.StepDrift, None, _))
    for
      why <- TimeAxis.steppedFault(
        Option.when(before.nonEmpty)(PausedLoop.newest(before)),
        read.map(_.validAt).min,
        PausedLoop.newest(read),
        team.settings.period
      )
    do
      team.log.note(EventKind.ClockBroken, None, why)
      throw LoopFailed(why)

  private def orFail[A](call: Future[Either[VehicleError, A]]): Future[A] =
    call.flatMap(_.fold(failed, Future.successful))

  private def standsStill(error: VehicleError) =
    s"the simulator could not be let run again and stands still: ${error.message}"

private object PausedFlight:
  /** Interval of checks whether the team is still held. */
  private val LookEvery = 100.millis

/** A loop cannot continue; the message states why. */
final class LoopFailed(message: String) extends RuntimeException(message)
