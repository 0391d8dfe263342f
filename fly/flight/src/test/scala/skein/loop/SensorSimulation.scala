package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future}
import skein.policy.*
import skein.port.{Sensor, VehicleError, VehiclePort}
import skein.record.{EventKind, MemoryRecorder, Recording, Samples}
import skein.signal.{LatencyProfile, Stamped}
import skein.testing.Optimised
import skein.units.*
import skein.vtime.VirtualTime

/** Policies that read sensors, through every loop in virtual time. */
class SensorSimulation extends munit.FunSuite, Optimised:

  /** Climbs using only its barometer, and hovers if that reading is too old. */
  private final case class ByBarometer(topM: Double, oldest: Span) extends Policy:
    override def sensors: Set[String] = Set("barometer")
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val climb = seen.sensed.get("barometer").filter(_.age < oldest).map: barometer =>
        (topM - barometer("altitudeM")).max(-2).min(2)
      (climb.fold(Action.Hover)(up => Action.Velocity(Vector3(0, 0, -up))), ())

  private val climbing = ByBarometer(26, Span.ofSeconds(2))
  private val fleet    = Fleet(Vector(
    Agent("Evader", Role.Traveller, MetresPerSecond(2), Vector3(0, 0, -20), Radians(0), climbing),
    Agent(
      "Pursuer",
      Role.Traveller,
      MetresPerSecond(2),
      Vector3(10, 0, -20),
      Radians(0),
      climbing.copy(topM = 15)
    )
  ))

  /** Repeats the vehicle's own reading after a delay; or returns something else. */
  private final class Barometer(
      vehicle: VehiclePort,
      delay: Span,
      says: Double => Either[VehicleError, Double]
  )(using
      system: ActorSystem
  ) extends Sensor:
    import system.dispatcher
    def columns: Vector[String]                                       = Vector("altitudeM")
    def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] =
      vehicle.read().flatMap: answer =>
        val altitude = answer.flatMap(read =>
          says(-read.value.positionNed.z).map(value => read.map(_ => IArray(value)))
        )
        if delay == Span.Zero then Future.successful(altitude)
        else
          after(delay.toDuration)(Future.successful(altitude.map(read =>
            read.copy(receivedAt = read.receivedAt + delay)
          )))

  private final class WithSensor(vehicle: VehiclePort, sensor: Sensor) extends VehiclePort:
    export vehicle.{act, hover, read}
    override def sensors: Map[String, Sensor] = Map("barometer" -> sensor)

  private def fly(
      kind: LoopKind,
      delay: Span = Span.Zero,
      fleet: Fleet = fleet,
      says: Double => Either[VehicleError, Double] = Right(_),
      sensor: Option[Clock => ActorSystem ?=> Sensor] = None
  ): Recording = VirtualTime
    .run(seed = 3): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val world              = FarQuadrotors(fleet, LatencyProfile.vpn, 3, clock)
      val heading            = Samples.heading.copy(flight = Samples.heading.flight.copy(loop = kind.label))
      val recorder           = MemoryRecorder(heading)
      val vehicles           = world.ports.map(vehicle =>
        WithSensor(vehicle, sensor.fold(Barometer(vehicle, delay, says))(_(clock)))
      )
      val settings = LoopSettings(planning = PlanSettings(slices = 2))
      val team     = Team(fleet, vehicles, clock, recorder, settings)
      Flight.start(kind, team, Some(world), Span.ofSeconds(20), clock, recorder).outcome.map(_ =>
        recorder.recording
      )
    .value

  private def lastAltitude(recording: Recording, vehicle: String) =
    -recording.readings.filter(_.vehicle == vehicle).last.state.value.positionNed.z

  for kind <- LoopKind.values do
    test(
      s"${kind.label}: a policy climbs using its sensor, and a replay of its recording makes equal decisions"
    ):
      val recording = fly(kind)
      assertEqualsDouble(lastAltitude(recording, "Evader"), 26, 0.5)
      assertEqualsDouble(lastAltitude(recording, "Pursuer"), 15, 0.5)
      assert(recording.measurements.sizeIs > 200, s"${recording.measurements.size} measurements")
      assertEquals(Replay(fleet, recording).firstDifference, None)

  /** A sensor with its own delay and a constant value. */
  private final class Slow(clock: Clock)(using ActorSystem) extends Sensor:
    def columns: Vector[String]                                       = Vector("altitudeM")
    def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] =
      val sentAt = clock.now()
      after(900.millis)(Future.successful(Right(Stamped(IArray(20.0), Instant.Epoch, sentAt, clock.now()))))

  for kind <- Seq(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive) do
    test(s"${kind.label}: a sensor that answers late delays neither readings nor commands"):
      def times(recording: Recording) =
        (
          recording.readings.map(read =>
            (read.vehicle, read.sequence, read.state.sentAt, read.state.receivedAt)
          ),
          recording.commands.map(command => (command.vehicle, command.sequence, command.sentAt))
        )
      // Nothing is read for a policy that does not request it.
      val without = fly(kind, fleet = Fleet(fleet.agents.map(_.copy(policy = Hovering))))
      val late    = fly(kind, sensor = Some(Slow(_)))
      assertEquals(without.measurements, Vector.empty)
      assert(late.sensings.nonEmpty)
      assertEquals(times(late), times(without))

  test("sensors are read a quarter of a period after the vehicle"):
    val recording = fly(LoopKind.Stream)
    for vehicle <- Seq("Evader", "Pursuer") do
      val first  = recording.readings.filter(_.vehicle == vehicle).map(_.state.sentAt).min
      val sensed = recording.measurements.filter(_.vehicle == vehicle).map(_.sentAt).min
      assertEquals(sensed.since(first), Span.ofMillis(25))

  test("a decision records the age of its sensor's reading"):
    val recording = fly(LoopKind.Stream, delay = Span.ofSeconds(3))
    // Too old for the policy: it hovers.
    assert(recording.sensings.nonEmpty)
    assert(recording.decisions.forall(_.action.contains(Action.Hover)))
    assertEqualsDouble(lastAltitude(recording, "Evader"), 20, 0.3)

  test("a sensor that fails, or returns invalid numbers, is recorded, and its last reading ages"):
    for says <- Seq(
        (_: Double) => Left(VehicleError.TimedOut("no answer in 500 ms")),
        (_: Double) => Right(Double.NaN)
      )
    do
      val recording =
        fly(LoopKind.Stream, says = altitude => if altitude > 22 then says(altitude) else Right(altitude))
      val told = recording.events.filter(_.detail.startsWith("barometer"))
      assert(told.exists(event => Set(EventKind.TimedOut, EventKind.Refused)(event.kind)), told.headOption)
      assert(recording.decisions.exists(_.action.contains(Action.Hover)))
      assertEquals(Replay(fleet, recording).firstDifference, None)

  test("a sensor that the vehicle lacks is reported before the flight"):
    val odd   = fleet.copy(agents = fleet.agents.map(_.copy(policy = Blind)))
    val error = intercept[IllegalArgumentException](fly(LoopKind.Stream, fleet = odd))
    assertEquals(
      error.getMessage,
      "the policy of Evader reads a sensor 'lidar' that the vehicle does not have: expected one of barometer"
    )

  private object Hovering extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) = (Action.Hover, ())

  private object Blind extends Policy:
    override def sensors: Set[String] = Set("lidar")
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) = (Action.Hover, ())
