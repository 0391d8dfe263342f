package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Success}
import skein.link.Clock
import skein.record.*
import skein.rpc.RpcError
import skein.units.*

/** The paper's model 1, the ground truth: the simulator stands still while every vehicle is read, decided for and
  * commanded; then it runs exactly one period. Time is the simulator's: no reading has an age.
  *
  * A step ends the flight at the first error, since a truth with gaps is none. The length of each step is verified
  * against the simulator's clock.
  */
object PausedLoop:

  def apply(team: Team, stepper: Stepper, steps: Long, clock: Clock, stopped: () => Boolean)(using
      ExecutionContext
  ): RunnableGraph[Future[Done]] =
    Source
      .unfoldAsync(Step(
        0,
        team.vehicles.map(team.start).toVector,
        Picture.empty(team.vehicles.size),
        Vector.empty
      )): step =>
        if step.number == steps || stopped() then land(team, stepper, step)
        else fly(team, stepper, clock, step)
      .toMat(Sink.ignore)(Keep.right)

  /** @param unanswered
    *   the moves of the step before, which end when this step's replace them
    */
  private case class Step(
      number: Long,
      memories: Vector[Memory],
      picture: Picture,
      unanswered: Vector[Future[Either[RpcError, Boolean]]]
  )

  private def fly(team: Team, stepper: Stepper, clock: Clock, step: Step)(using
      ExecutionContext
  ): Future[Option[(Step, Done)]] =
    for
      _        <- if step.number == 0 then orFail(stepper.pause()) else Future.unit
      readings <- orFail(team.readAll())
      now     = readings(0).state.validAt
      picture =
        readings.foldLeft(step.picture)((seen, reading) => seen.withReading(reading._1, timeless(reading._2)))
      _       = verifyStep(team, step, now)
      decided =
        team.vehicles.toVector.map(vehicle => team.decideAt(vehicle, step.memories(vehicle), picture, now))
      moves =
        for (vehicle, (_, decision)) <- team.vehicles.toVector.zip(decided)
        yield send(team, clock, vehicle, decision, picture)
      // A move has reached the simulator when the one that it replaces has ended.
      _ <- Future.sequence(step.unanswered)
      _ <- orFail(stepper.continueFor(team.settings.period))
    yield
      val moved = team.vehicles.zip(decided).foldLeft(picture):
        case (seen, (vehicle, (_, decision))) =>
          seen.withMove(Move(vehicle, decision.sequence, decision.heading.value, now, decision.speed))
      Some((Step(step.number + 1, decided.map(_._1), moved, moves), Done))

  /** Ends the last moves and lets the simulator run again. */
  private def land(team: Team, stepper: Stepper, step: Step)(using ExecutionContext): Future[None.type] =
    for
      _ <- team.hoverAll()
      _ <- Future.sequence(step.unanswered)
      _ <- orFail(stepper.resume())
    yield None

  /** While the simulator stands still, no time passes between question and answer. */
  private[loop] def timeless(reading: Reading): Reading =
    val at = reading.state.validAt
    reading.copy(state = reading.state.copy(sentAt = at, receivedAt = at))

  private def send(team: Team, clock: Clock, vehicle: Int, decision: Decision, picture: Picture)(using
      ExecutionContext
  ): Future[Either[RpcError, Boolean]] =
    team.record(vehicle, decision, picture)
    team.sent(vehicle, decision, clock.now())
    team.move(vehicle, decision).andThen(result => team.ended(vehicle, decision, clock.now(), result))

  private def verifyStep(team: Team, step: Step, now: Instant): Unit =
    for before <- step.picture.readings(0) do
      val stepped = now.since(before.state.validAt)
      if stepped != team.settings.period then
        team.note(
          EventKind.StepDrift,
          None,
          s"step ${step.number} took ${stepped.toMillis} ms of simulator time instead of ${team.settings.period.toMillis} ms"
        )

  private def orFail[A](call: Future[Either[RpcError, A]])(using ExecutionContext): Future[A] =
    call.transform:
      case Success(Right(value)) => Success(value)
      case Success(Left(error))  => Failure(LoopFailed(error.message))
      case Failure(error)        => Failure(error)

/** Why a loop cannot go on. */
final class LoopFailed(message: String) extends RuntimeException(message)
