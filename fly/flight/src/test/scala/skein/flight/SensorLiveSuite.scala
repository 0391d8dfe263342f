package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.airsim.*
import skein.link.{Address, TcpTransport}
import skein.loop.*
import skein.policy.*
import skein.record.{ClockKind, MemoryRecorder, Recording}
import skein.rpc.RpcClient
import skein.scenario.Scenario
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.units.*

/** Over real sockets and on the real clock, every loop side by side: AirSim's sensors in decisions. */
class SensorLiveSuite extends munit.FunSuite, Unhurried:
  private given system: ActorSystem = ActorSystem("SensorLiveSuite")
  override def afterAll(): Unit     = { val _ = Await.result(system.terminate(), 10.seconds) }

  /** Keeps the altitude above sea level that it finds. */
  private object KeepAltitude extends Policy:
    override def sensors: Set[String] = Set("barometer", "imu")
    type Memory = Option[Double]
    def start: Option[Double]                                                       = None
    def choose(seen: Observation, memory: Option[Double]): (Action, Option[Double]) =
      seen.sensed.get("barometer").map(_("altitudeM")) match
        case None           => (Action.Hover, memory)
        case Some(altitude) =>
          val kept = memory.getOrElse(altitude)
          (Action.Velocity(Vector3(1, 0, altitude - kept)), Some(kept))

  private case class Alone() extends Scenario:
    def agents: Vector[Agent] = Vector(
      Agent("Drone", Role.Traveller, MetresPerSecond(1), Vector3(0, 0, -20), Radians(0), KeepAltitude)
    )

  private val fleet = Alone().fleet

  private def fly(kind: LoopKind): Future[Recording] =
    import system.dispatcher
    val drone = Vector(VehicleSettings("Drone"))
    val world =
      SimulatorSettings(WorldSettings.of(drone), Address("127.0.0.1", 0))
    val flight   = PortFlight(kind.label, kind, Alone(), Span.ofSeconds(3), ClockKind.Real, Clock.system)
    val recorder = MemoryRecorder(flight.heading)
    for
      server <- SimulatorServer.start(world, TcpTransport(), Clock.system)
      client =
        AirSimClient(RpcClient(
          TcpTransport(),
          server.address,
          Clock.system,
          AirSimFleet.rpcSettings(kind)
        ))
      ready <-
        Preparation(client, Clock.system).place(fleet).map(_.fold(fail(_), identity))
      ports = ready.map(Vehicles.port(_, _ => ()))
      landed <- flight.start(ports, recorder, Some(AirSimTime(client))).landed
      _ = assertEquals(landed.outcome, FlightOutcome.Completed)
      _ <- client.close()
      _ <- server.close()
    yield recorder.recording

  test("every loop but plan flies by AirSim's barometer, and its recording replays to equal decisions"):
    import system.dispatcher
    val loops = LoopKind.values.toVector.filterNot(_ == LoopKind.Plan)
    Future.traverse(loops)(kind => fly(kind).map((kind, _))).map: flown =>
      for (kind, recording) <- flown do
        val sensors = recording.measurements.groupBy(_.sensor)
        assertEquals(sensors.keySet, Set("barometer", "imu"), kind.label)
        assert(sensors("barometer").sizeIs > 3, s"${kind.label}: ${sensors("barometer").size} measurements")
        assertEquals(sensors("imu").head.quantities.size, 6)
        assert(recording.sensings.sizeIs > 3, s"${kind.label}: ${recording.sensings.size} sensings")
        assert(recording.decisions.exists(_.action.exists(_ != Action.Hover)), kind.label)
        assertEquals(Replay(fleet, recording).firstDifference, None, kind.label)
