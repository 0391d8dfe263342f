package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.policy.Action
import skein.port.{SteppedTime, VehicleError, VehiclePort}
import skein.record.{Event, EventKind, MeasurementRow, Recorder}
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.units.Decimals.fixed
import skein.vehicle.GoTo

/** An environment of another framework as a simulator: paused, stepped, or run by the clock. It is stepped as
  * late as possible: at each reading or command, by the number of steps that became due since the last one,
  * each under the velocities commanded before it. So it needs no thread of its own, and works in virtual time
  * and live.
  *
  * If the steps last longer than the time that they simulate, simulated time falls behind the clock, and an
  * event says by how much. Time spent in a step is then not made up for.
  *
  * A reading shows the state after the last step. Every step's rewards and ends are recorded, as measurements
  * of each vehicle by the sensor [[EnvironmentSimulator.Sensor]].
  *
  * @param on executes the blocking calls: one thread, in the order of submission
  */
final class EnvironmentSimulator private (
    process: EnvironmentProcess,
    begun: EnvironmentProcess.Moment,
    names: Vector[String],
    clock: Clock,
    recorder: Recorder,
    on: ExecutionContext
)(using system: ActorSystem)
    extends SteppedTime:
  import EnvironmentSimulator.*
  private given ExecutionContext = on

  // Used on that thread alone.
  private var steps      = 0L
  private var last       = begun
  private var paused     = false
  private var velocities = names.map(_ => Vector3.Zero)
  private val underWay   = names.map(_ => Promise.successful(Right(false)): Promise[Answer]).toArray
  private var failed     = Option.empty[VehicleError]

  // Simulated time was `anchored` at `anchoredAt`, on the controller's clock. Begins at the first reading.
  private var anchored   = Span.Zero
  private var anchoredAt = Option.empty[Instant]

  private var behind  = Span.Zero
  private var notedAt = Option.empty[Instant]

  /** The vehicles, in the order of their names. They accept velocities, positions, and hover. */
  val vehicles: Vector[VehiclePort] = names.indices.toVector.map(Vehicle(_))

  def pause(): Future[Either[VehicleError, Unit]] = asked:
    if anchoredAt.isDefined then catchUp()
    paused = true

  def resume(): Future[Either[VehicleError, Unit]] = asked:
    if paused then
      paused = false
      anchored = begun.step * steps
      anchoredAt = Some(clock.now())

  /** Runs for this span, which must be a multiple of the environment's step. */
  def continueFor(span: Span): Future[Either[VehicleError, Unit]] =
    if span.toNanos % begun.step.toNanos == 0 then
      asked:
        val until = steps + span.toNanos / begun.step.toNanos
        while steps < until && failed.isEmpty do stepOnce()
    else
      Future.successful(Left(VehicleError.Refused(
        s"expected a multiple of ${begun.step.toMillis} ms, the environment's step, got ${span.toMillis} ms"
      )))

  private def asked(change: => Unit): Future[Either[VehicleError, Unit]] = Future:
    change
    failed.toLeft(())

  /** Steps the environment up to the clock's time at this call. */
  private def catchUp(): Unit = if !paused then
    val now    = clock.now()
    val due    = anchored + now.since(anchoredAt.getOrElse(now))
    val before = steps
    if anchoredAt.isEmpty then anchoredAt = Some(now)
    while failed.isEmpty && begun.step * (steps + 1) <= due do stepOnce()
    val (ended, simulates) = (clock.now(), begun.step * (steps - before))
    // Else the steps that become due meanwhile would never end.
    if steps > before && ended.since(now) > simulates then
      anchored = due
      anchoredAt = Some(ended)
      fellBehind(ended.since(now), ended)

  private def fellBehind(by: Span, now: Instant): Unit =
    behind = behind + by
    if notedAt.forall(now.since(_) >= NoteEvery) then
      notedAt = Some(now)
      val detail =
        s"the environment's steps take too long: it is ${behind.toSeconds.fixed(2)} s behind the clock"
      recorder.offer(Event(now, EventKind.ClockDrift, None, detail))

  private def stepOnce(): Unit = process.step(velocities) match
    case Left(reason)  => failed = Some(VehicleError.Lost(s"the environment: $reason", mayHaveRun = true))
    case Right(moment) =>
      steps += 1
      last = moment
      val now = clock.now()
      for (name, agent) <- names.zip(moment.agents) do
        recorder.offer(MeasurementRow(
          steps,
          name,
          Sensor,
          Columns,
          Vector(agent.reward, if agent.terminated then 1 else 0, if agent.truncated then 1 else 0),
          simulated,
          now,
          now
        ))

  private def simulated: Instant = Instant.Epoch + begun.step * steps

  private final class Vehicle(index: Int) extends VehiclePort:
    def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
      val sentAt = clock.now()
      Future:
        catchUp()
        failed.toLeft(Stamped(last.agents(index).kinematics, simulated, sentAt, clock.now()))

    def act(action: Action, lasts: Span): Future[Answer] = action.byVelocity match
      case Action.Velocity(velocity, _)            => go(lasts)(_ => velocity)
      case Action.VelocityAt(north, east, down, _) =>
        go(lasts)(now =>
          Vector3(north, east, (down.value - now.positionNed.z).max(-MostClimbMps).min(MostClimbMps))
        )
      case Action.Position(place, speed, _) =>
        go(lasts)(now => GoTo.velocityNed(now.positionNed, now.velocityNed, place, speed))
      case Action.Hover => hover()
      case other        =>
        Future.successful(Left(VehicleError.Unsupported(s"${names(index)} follows velocities, not $other")))

    def hover(): Future[Answer] =
      val done = Promise[Answer]()
      replace(done, _ => Vector3.Zero)(done.trySuccess(Right(true)): Unit)
      done.future

    private def go(lasts: Span)(velocity: Kinematics => Vector3): Future[Answer] =
      val ended = Promise[Answer]()
      replace(ended, velocity):
        val over = system.scheduler.scheduleOnce(lasts.toDuration)(expire(ended))
        ended.future.onComplete(_ => over.cancel())
      ended.future

    private def replace(next: Promise[Answer], velocity: Kinematics => Vector3)(begin: => Unit): Unit =
      val _ = Future:
        catchUp()
        failed match
          case Some(error) => next.trySuccess(Left(error)): Unit
          case None        =>
            velocities = velocities.updated(index, velocity(last.agents(index).kinematics))
            underWay(index).trySuccess(Right(false)): Unit
            underWay(index) = next
            begin

    private def expire(ended: Promise[Answer]): Unit =
      val _ = Future:
        catchUp()
        if (underWay(index) eq ended) && ended.trySuccess(Right(true)) then
          velocities = velocities.updated(index, Vector3.Zero)

object EnvironmentSimulator:
  /** Maximum vertical speed towards a commanded altitude, m/s. */
  private val MostClimbMps = 3.0

  private val NoteEvery = Span.ofSeconds(5)

  private type Answer = Either[VehicleError, Boolean]

  /** Name and columns of its measurements in a recording; 1 stands for true. */
  val Sensor                  = "environment"
  val Columns: Vector[String] = Vector("reward", "terminated", "truncated")

  /** Begins an episode; blocks until it has begun.
    *
    * @param names the vehicles' names
    * @return Left says why there is none
    */
  def start(
      process: EnvironmentProcess,
      names: Vector[String],
      clock: Clock,
      recorder: Recorder,
      on: ExecutionContext
  )(using ActorSystem): Either[String, EnvironmentSimulator] =
    for
      begun <- process.reset()
      _     <-
        Expect.that(begun.step > Span.Zero)(s"stepS: expected more than 0, got ${begun.step.toSeconds}")
    yield new EnvironmentSimulator(process, begun, names, clock, recorder, on)
