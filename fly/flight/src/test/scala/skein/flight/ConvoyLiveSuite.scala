package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.link.TcpTransport
import skein.loop.{LoopKind, FlightOutcome}
import skein.measure.RecordedTracks
import skein.record.{EventKind, MemoryRecorder}
import skein.scenario.{Convoy, Result, Tracks}
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.{Lengthy, Waiting}
import skein.units.*

/** Two cars and three drones over real sockets, by the clock. */
class ConvoyLiveSuite extends munit.FunSuite, Lengthy, Waiting:
  private given system: ActorSystem = ActorSystem("convoy")

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  for loop <- Seq(LoopKind.Stream, LoopKind.Predictive) do
    test(s"drones escort cars round a circuit, live: ${loop.label} over direct"):
      val settings = FlySettings(
        List(loop),
        List(LatencyProfile.direct),
        Span.ofSeconds(25),
        Span.ofMillis(100),
        seed = 1,
        Convoy()
      )
      val plan      = settings.plans.last
      val assembler = FlightAssembler(TcpTransport(), Clock.system, settings, simulator = None)
      val recorder  = MemoryRecorder(assembler.heading(plan, "real"))
      val assembly  = Await.result(assembler.start(plan, recorder), 1.minute).fold(fail(_), identity)
      assertEquals(Await.result(assembly.landed, 1.minute).outcome, FlightOutcome.Completed)
      val recording = recorder.recording
      val result    = Result.of(Convoy(), Tracks.of(RecordedTracks.of(recording)).get)
      val told      = result.measured.map(one => s"${one.measure.name} ${one.value.getOrElse("none")}")
      println(s"${loop.label}: ${told.mkString(", ")}")
      // Virtual flights reach 2; a busy machine adds to that.
      assert(result.value("off places").exists(_ < 4), result.measured)
      assertEqualsDouble(result.value("between cars").get, 12, 3)
      assertEquals(recording.events.filter(_.kind == EventKind.Refused), Vector.empty)
      val lead = recording.readings.filter(_.vehicle == "Lead").map(_.state.value)
      assert(lead.forall(_.positionNed.z == 0))
      assert(lead.last.positionNed.x > 20 || lead.last.positionNed.y > 10, lead.last)
