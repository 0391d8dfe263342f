package skein.loop

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.ExecutionContext
import skein.record.{EventKind, MemoryRecorder, Recording, Samples}
import skein.scenario.PaperDuel
import skein.signal.LatencyProfile
import skein.units.*
import skein.vtime.VirtualTime

/** When vehicles are read, and what is recorded if they do not answer. */
class AskingSuite extends munit.FunSuite:
  private val start = Instant.Epoch

  private def flown(
      kind: LoopKind,
      link: LatencyProfile,
      settings: LoopSettings = LoopSettings(),
      duration: Span = Span.ofSeconds(1)
  ): Recording = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val virtual            = Clock.ofNanos(VirtualTime.clock(system))
      val began              = virtual.now()
      val clock              = Clock.ofNanos(() => virtual.now().since(began).toNanos)
      val fleet              = PaperDuel(pairs = 2).fleet
      val world              = FarQuadrotors(fleet, link, 1, clock)
      val recorder           = MemoryRecorder(Samples.heading)
      val team               = Team(fleet, world.ports, clock, recorder, settings)
      Flight.start(kind, team, Some(world), duration, clock, recorder).outcome.map(_ => recorder.recording)
    .value

  private def firstAsked(recording: Recording): Seq[Double] =
    PaperDuel(pairs = 2).fleet.agents.map: agent =>
      recording.readings.filter(_.vehicle == agent.name).map(_.state.sentAt).min.since(start).toMillis

  test("stream reads all vehicles simultaneously; as published, one after another over the period"):
    assertEquals(firstAsked(flown(LoopKind.Stream, LatencyProfile.none)), Seq(0.0, 0.0, 0.0, 0.0))
    val published = flown(LoopKind.Stream, LatencyProfile.none, LoopSettings().asPublished)
    assertEquals(firstAsked(published), Seq(0.0, 25.0, 50.0, 75.0))

  private def missedSteps(recording: Recording) =
    recording.events.filter(_.kind == EventKind.Skipped).map(event => (event.at.since(start), event.detail))

  test("futures record the steps that they miss while the limit is running, and none if all end in time"):
    assertEquals(missedSteps(flown(LoopKind.Futures, LatencyProfile.direct)), Vector.empty)
    // Four steps begin before the first has ended, after 4 × 137 ms; of the two that are due by then one is
    // missed.
    assertEquals(
      missedSteps(flown(LoopKind.Futures, VirtualGame.constant(137))).head,
      (Span.ofMillis(548), "1 steps missed: too many futures run")
    )
    // Four vehicles are read one after the other, 2 s each; four steps run at a time, one future for each
    // vehicle.
    val slow        = flown(LoopKind.Futures, VirtualGame.constant(2000), duration = Span.ofSeconds(9))
    val (at, noted) = missedSteps(slow).head
    assertEquals(at, Span.ofSeconds(8))
    // Of the 81 that were due by then, four had run and one runs now.
    val missed = noted match
      case s"$missed steps missed: too many futures run" => missed.toInt
      case other                                         => fail(other)
    assert((75 to 76).contains(missed), noted)
