package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.{Address, TcpTransport}
import skein.loop.{FlightOutcome, LoopKind}
import skein.record.{MemoryRecorder, Recording}
import skein.scenario.{PaperDuel, Scenarios}
import skein.settings.{FlySettings, VehicleLink}
import skein.signal.LatencyProfile
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.{TemporaryFolders, Waiting}
import skein.units.*

/** A controller for each vehicle, over real sockets and by the clock. */
class DecentralisedLiveSuite extends munit.FunSuite, TemporaryFolders, Waiting:
  private given Scenarios           = Scenarios.ours
  private given system: ActorSystem = ActorSystem("DecentralisedLiveSuite")
  override def afterAll(): Unit     = { val _ = Await.result(system.terminate(), 10.seconds) }
  import system.dispatcher

  for between <- Seq(None, Some("loss:10%,constant:40ms")) do
    folder.test(
      s"in every loop each controller decides for its own vehicle, and decisions replay; messages $between"
    ): folder =>
      val settings = FlySettings(
        List(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive),
        List(LatencyProfile.direct),
        duration = Span.ofSeconds(5),
        period = Span.ofMillis(100),
        seed = 1,
        decentralised = true,
        between = between.map(VehicleLink.parse(_).fold(fail(_), identity))
      )
      val assembler = FlightAssembler(TcpTransport(), Clock.system, settings, simulator = None)
      val flown     = Future.traverse(settings.plans): plan =>
        val recorder = MemoryRecorder(assembler.heading(plan, clockKind = "real"))
        assembler.start(plan, recorder).flatMap(_.fold(fail(_), _.landed)).map((_, recorder))
      for (landed, recorder) <- Await.result(flown, 60.seconds) do
        val plan = landed.plan
        assertEquals(landed.outcome, FlightOutcome.Completed, plan.id)
        assert(recorder.writeTo(plan.file(folder)).isRight)
        assertEquals(Replayed.of(plan.file(folder)).map(_.decidedAgain), Right(None), plan.id)
        assertOwn(recorder.recording)

  folder.test("two programs fly a vehicle each in a running simulator, and each records its own decisions"):
    folder =>
      val both = FlySettings(
        List(LoopKind.Predictive),
        List(LatencyProfile.direct),
        duration = Span.ofSeconds(3),
        period = Span.ofMillis(100),
        seed = 1,
        scenario = PaperDuel(altitudeM = 4),
        decentralised = true
      )
      val standing = both.fleet.agents.map(agent =>
        VehicleSettings(agent.name, agent.startPositionNed.copy(z = 0), Radians(0))
      )
      val world = SimulatorSettings(WorldSettings.of(standing), Address("127.0.0.1", 0))

      def fly(name: String, at: Address) =
        val settings  = both.copy(only = Some(name))
        val plan      = settings.plans.head.copy(id = name)
        val assembler = FlightAssembler(TcpTransport(), Clock.system, settings, Some(at))
        val recorder  = MemoryRecorder(assembler.heading(plan, clockKind = "real"))
        assembler.start(plan, recorder).flatMap(_.fold(fail(_), _.landed)).map((_, recorder))
      val flown =
        for
          server <- SimulatorServer.start(world, TcpTransport(), Clock.system)
          landed <- Future.traverse(Vector("Pursuer", "Evader"))(fly(_, server.address))
          _      <- server.close()
        yield landed
      for (landed, recorder) <- Await.result(flown, 90.seconds) do
        val (name, recording) = (landed.plan.id, recorder.recording)
        assertEquals(landed.outcome, FlightOutcome.Completed, name)
        assertEquals(recording.decisions.map(_.vehicle).toSet, Set(name))
        assertEquals(recording.commands.map(_.vehicle).toSet, Set(name))
        assertEquals(recording.readings.map(_.vehicle).toSet, Set("Pursuer", "Evader"))
        assert(recorder.writeTo(landed.plan.file(folder)).isRight)
        assertEquals(Replayed.of(landed.plan.file(folder)).map(_.decidedAgain), Right(None), name)

  private def assertOwn(recording: Recording): Unit =
    val names = recording.heading.vehicles.map(_.name)
    for (name, self) <- names.zipWithIndex do
      val made = recording.decisions.filter(_.vehicle == name)
      assert(made.nonEmpty, s"no decision for $name")
      assertEquals(made.map(_.own.sequence % names.size).toSet, Set(self.toLong), name)
