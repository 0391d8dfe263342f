package skein.loop

import java.util.concurrent.atomic.{AtomicLongArray, AtomicReference}
import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.{Flow, Source}
import scala.concurrent.{ExecutionContext, Future}
import skein.flow.{JoinLatest, Metronome, Sense}
import skein.port.{VehicleError, VehiclePort}
import skein.record.EventKind
import skein.signal.{ClockAlignment, Stamped}
import skein.units.*

/** Reads a team's vehicles and their sensors, and records the answers. */
private final class TeamSensing(
    ports: Vector[VehiclePort],
    clocksBefore: Option[ClockAlignment],
    messages: Option[Messages],
    parts: TeamParts
)(using ExecutionContext):
  import parts.{clock, fleet, log, own, settings}

  private val meters = ports.indices.map(parts.meter("sense", _))

  // `futures` reads one vehicle from several threads concurrently.
  private val asked = AtomicLongArray(ports.size)

  // Updated as answers arrive, before they are used.
  private val clocks = AtomicReference(clocksBefore)

  /** The inboxes of vehicles that are known by messages instead of readings. */
  private val inboxes: Map[Int, Inbox] =
    val others = messages.toVector.flatMap(_ => ports.indices.filterNot(own.contains))
    others
      .map: vehicle =>
        def dropped(message: Reading) =
          log.note(EventKind.Dropped, Some(vehicle), s"reading ${message.sequence}: too many messages wait")
        vehicle -> Inbox(isNewer, dropped)
      .toMap

  for by <- messages do
    by.onReceived: message =>
      log.read(message)
      inboxes(message.vehicle).put(message)

  /** Aligns the vehicles' clock by a reading, and records a contradiction between the clocks.
    *
    * @param isRunning whether the simulator's clock runs by itself
    */
  private def align(reading: Reading, isRunning: Boolean): Unit =
    import reading.{sequence, state}
    val before = clocks.getAndUpdate(known => Some(known.fold(ClockAlignment.of(state))(_.updated(state))))
    if isRunning && before.exists(known => clocks.get.exists(_.restarts > known.restarts)) then
      for anew <- before.flatMap(_.contradiction(state)) do
        log.note(EventKind.ClockRestarted, Some(reading.vehicle), s"reading $sequence: $anew")

  /** Reads a vehicle; records the answer or the error, and contradictions between the clocks. Thread-safe.
    *
    * @param isRunning whether the simulator's clock runs by itself
    */
  def read(vehicle: Int, isRunning: Boolean = true): Future[Either[VehicleError, Reading]] =
    inboxes.get(vehicle).fold(ask(vehicle, isRunning))(_.read().map(Right(_)))

  private def ask(vehicle: Int, isRunning: Boolean): Future[Either[VehicleError, Reading]] =
    val sequence = Reading.number(asked.getAndIncrement(vehicle), own, ports.size)
    val meter    = meters(vehicle)
    meter.called()
    ports(vehicle)
      .read()
      .map:
        case Right(state) =>
          val reading = Reading(vehicle, sequence, state)
          align(reading, isRunning)
          meter.answered()
          meter.pass(ageOf(Some(state.validAt)))
          log.read(reading)
          messages.foreach(_.send(reading))
          Right(reading)
        case Left(error) =>
          meter.answered()
          log.unread(vehicle, sequence, error)
          Left(error)

  /** Whether one answer was sampled later than another, according to all readings of the team. */
  def isNewer(one: Stamped[?], other: Stamped[?]): Boolean =
    clocks.get.getOrElse(ClockAlignment.of(one)).isNewer(one, other)

  /** Reads one vehicle once a period from a start on; emits answers in order, never an older one after a
    * newer. All vehicles are read in phase, unless the settings spread them; a random phase between them
    * would make the data of one older than that of the other. Of a vehicle that is known by messages, emits
    * these as they arrive.
    */
  def sense(vehicle: Int, start: Instant): Source[Reading, NotUsed] =
    inboxes
      .get(vehicle)
      .fold(senseByAsking(vehicle, start))(_.messages)
      .addAttributes(parts.named("sense", vehicle))

  private def senseByAsking(vehicle: Int, start: Instant): Source[Reading, NotUsed] =
    val offset = settings.spread * vehicle.toLong / ports.size.toLong
    Sense
      .at[VehicleError, Reading, NotUsed](
        ticks(start + offset),
        settings.window,
        settings.early,
        isNewer = (answered, held) => isNewer(answered.state, held.state)
      )(() => read(vehicle))(
        onSkip = _.foreach(reading =>
          log.note(EventKind.Dropped, Some(vehicle), s"reading ${reading.sequence} overtaken")
        ),
        onMissed =
          ticks => log.note(EventKind.Skipped, Some(vehicle), s"$ticks ticks missed: window full")
      )

  /** Joins the newest readings of all vehicles, each with its vehicle; emits when one is new, for decisions
    * of its own.
    */
  def joinLatest: Flow[(Int, Reading), LoopEvent, NotUsed] =
    val everyone = ports.indices.toSet
    Flow
      .fromGraph(
        JoinLatest[Int, Reading](everyone, settings.patience)(
          isNewer = (arrived, held) => isNewer(arrived.state, held.state),
          onStale = (vehicle, reading) =>
            log.note(EventKind.Dropped, Some(vehicle), s"reading ${reading.sequence} is stale")
        )
      )
      .map(newest => LoopEvent.Seen(newest.values.toVector, own.toSet))
      .addAttributes(parts.named("join latest"))

  private val sensors = own.flatMap: vehicle =>
    fleet.agents(vehicle).policy.sensors.toVector.sorted.map: name =>
      TeamSensor(vehicle, name, ports(vehicle).sensors(name), log)

  /** Readings of the policies' sensors: a periodic source for each, which blocks nothing. Sensors are read a
    * quarter of a period after the vehicles.
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

  /** Reads every sensor that a policy uses, in sequence; ends at the first error. */
  def senseAll(): Future[Either[VehicleError, Vector[SensorReading]]] =
    inTurn(sensors)(_.read())

  /** Reads all vehicles in the scenario's order; ends at the first error. The states of vehicles that are
    * known by messages are those of the newest message after this controller's own vehicle was read.
    *
    * @param isRunning whether the simulator's clock runs by itself
    */
  def readAll(isRunning: Boolean = true): Future[Either[VehicleError, Vector[Reading]]] =
    val all = if messages.isEmpty then ports.indices else own ++ inboxes.keys.toVector.sorted
    inTurn(all)(read(_, isRunning))

  /** Asks one after the other, until one fails. */
  private def inTurn[A, B](all: Seq[A])(
      ask: A => Future[Either[VehicleError, B]]
  ): Future[Either[VehicleError, Vector[B]]] =
    all.foldLeft(Future.successful[Either[VehicleError, Vector[B]]](Right(Vector.empty))): (soFar, next) =>
      soFar.flatMap:
        case Right(answers) => ask(next).map(_.map(answers :+ _))
        case error          => Future.successful(error)

  /** Emits the number of ticks due since the last element, once per period from a given instant. */
  def ticks(first: Instant): Source[Int, NotUsed] =
    Source.fromGraph(Metronome(first, settings.period, clock))

  /** The present age of a moment on the vehicles' clock; absent until that clock is known. */
  def ageOf(validAt: Option[Instant]): Option[Span] =
    clocks.get
      .zip(validAt)
      .map((known, valid) => clock.now().since(known.toController(valid)))
      .filter(_ >= Span.Zero)

  /** The present age of the oldest reading of a view. */
  def ageOf(view: TeamView): Option[Span] =
    ageOf(view.readings.flatten.map(_.state.validAt).minOption)
