package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.*
import skein.loop.{LoopKind, FlightOutcome}
import skein.record.{MemoryRecorder, Recording}
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.{Lengthy, Waiting}
import skein.units.*

/** [[RunningSimulatorSimulation]] over real sockets and on the real clock, shortened; the simulator's clock
  * runs faster, since the ways to the starts are most of it.
  */
class RunningSimulatorLiveSuite extends munit.FunSuite, Waiting, Lengthy:
  private given system: ActorSystem = ActorSystem("RunningSimulatorLiveSuite")
  override def afterAll(): Unit     = { val _ = Await.result(system.terminate(), 10.seconds) }

  private val settings = FlySettings(
    List(LoopKind.Stream, LoopKind.Futures),
    List(LatencyProfile.none),
    duration = Span.ofSeconds(2),
    period = Span.ofMillis(100),
    seed = 1
  )

  private val duel = Vector(
    VehicleSettings("Evader", Vector3(0, 0, 0), Radians(0)),
    VehicleSettings("Pursuer", Vector3(-20, 5, -2), Radians(math.toRadians(99)))
  )

  test("two flights one after another against one simulator begin at rest at their starts"):
    import system.dispatcher
    val transport = TcpTransport()
    val world     =
      SimulatorSettings(
        WorldSettings.of(duel),
        Address("127.0.0.1", 0)
      )
    def fly(assembler: FlightAssembler, before: Vector[Recording]): Future[Vector[Recording]] =
      if before.size == settings.plans.size then Future.successful(before)
      else
        val plan     = settings.plans(before.size)
        val recorder = MemoryRecorder(assembler.heading(plan, "real"))
        for
          assembly <- assembler.start(plan, recorder).map(_.fold(fail(_), identity))
          landed   <- assembly.landed
          _ = assertEquals(landed.outcome, FlightOutcome.Completed)
          all <- fly(assembler, before :+ recorder.recording)
        yield all
    val flown =
      for
        server <- SimulatorServer.start(world, transport, Clock.system)
        flown  <- fly(FlightAssembler(transport, Clock.system, settings, Some(server.address)), Vector.empty)
        _      <- server.close()
      yield flown
    flown.map: recordings =>
      for recording <- recordings; vehicle <- recording.heading.vehicles do
        val first = recording.readings.filter(_.vehicle == vehicle.name).minBy(_.sequence).state.value
        assert((first.positionNed - vehicle.startNed).norm <= 0.3, s"$vehicle: $first")
        assert(first.velocityNed.norm <= 0.1, s"$vehicle: $first")
