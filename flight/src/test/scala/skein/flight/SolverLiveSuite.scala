package skein.flight

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.link.{Address, TcpTransport}
import skein.loop.{Fallback, LoopKind, Outcome, PlanSettings, Replay}
import skein.policy.Action
import skein.record.{EventKind, MemoryRecorder}
import skein.scenario.Scenarios
import skein.settings.{FlySettings, RecordedPlan, SolverChoice}
import skein.signal.LatencyProfile
import skein.solver.*
import skein.testing.Optimised
import skein.units.*

/** A solver behind real sockets on loopback. */
class SolverLiveSuite extends munit.FunSuite, Optimised:
  private given system: ActorSystem = ActorSystem("SolverLiveSuite")
  private given Scenarios           = Scenarios.ours
  import system.dispatcher

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private def served(id: Long, at: Address): Future[SolverServer] =
    val desk = SolverDesk(
      id,
      "same",
      Briefing.plan(_).map(FlightDeciders.of(_, FlightAssembler.threads)),
      Clock.system,
      system.dispatcher
    )
    SolverServer.start(at, TcpTransport(), desk)

  test("plans come from a solver, within the deadline, and replay"):
    val server   = Await.result(served(1, Address("127.0.0.1", 0)), 10.seconds)
    val settings = FlySettings(
      List(LoopKind.Plan),
      List(LatencyProfile.none),
      duration = Span.ofSeconds(5),
      period = Span.ofMillis(100),
      seed = 7,
      deadline = Some(Span.ofMillis(600)),
      // A slice is searched in that time on a busy machine, too.
      planning = PlanSettings(Span.ofMillis(200), horizonSteps = 10, searches = 1, blocksPerSlice = 1),
      fallback = Fallback.Hover,
      solver = Some(SolverChoice.Tcp(server.address))
    )
    val assembler = FlightAssembler(
      TcpTransport(),
      Clock.system,
      settings,
      None,
      workers = _ => fail("the flight's own process was to plan"),
      solvers = Solvers("same", _ => Right(TcpLink(TcpTransport(), server.address)))
    )
    val plan     = settings.plans.last
    val recorder = MemoryRecorder(assembler.heading(plan, "real"))
    val flown    =
      for
        started <- assembler.start(plan, recorder)
        landed  <- started.fold(fail(_), _.landed)
        _       <- server.close()
      yield landed.outcome
    assertEquals(Await.result(flown, 60.seconds), Outcome.Completed)
    val recording = recorder.recording
    assert(recording.planned.sizeIs > 5, recording.planned.size)
    assert(recording.planned.exists(_.candidates > 0))
    for one <- recording.solved if one.vehicle == "Pursuer" do
      assert(one.thinking >= settings.planning.deadline, one)
    val again = RecordedPlan.of(recording).fold(fail(_), identity)
    assertEquals(Replay(again.fleet, recording, again.settings.planningByModel).firstDifference, None)

  test("a solver that ends and is started again in a flight: the flight hovers, flies on, and replays"):
    val first    = Await.result(served(1, Address("127.0.0.1", 0)), 10.seconds)
    val at       = first.address
    val settings = FlySettings(
      List(LoopKind.Predictive),
      List(LatencyProfile.none),
      duration = Span.ofSeconds(5),
      period = Span.ofMillis(100),
      seed = 7,
      fallback = Fallback.Hover,
      solver = Some(SolverChoice.Tcp(at))
    )
    val assembler = FlightAssembler(
      TcpTransport(),
      Clock.system,
      settings,
      None,
      solvers = Solvers("same", _ => Right(TcpLink(TcpTransport(), at)))
    )
    val plan     = settings.plans.last
    val recorder = MemoryRecorder(assembler.heading(plan, "real"))
    val flown    =
      for
        started <- assembler.start(plan, recorder)
        _       <- after(1500.millis, system.scheduler)(first.close())
        second  <- after(1.second, system.scheduler)(served(2, at))
        landed  <- started.fold(fail(_), _.landed)
        _       <- second.close()
      yield landed.outcome
    assertEquals(Await.result(flown, 60.seconds), Outcome.Completed)
    val recording              = recorder.recording
    def times(kind: EventKind) = recording.events.filter(_.kind == kind).map(_.at)
    val (lost, back)           = (times(EventKind.Disconnected).head, times(EventKind.Reconnected).head)
    assert(recording.decisions.exists(made => made.decidedAt > lost && made.action.contains(Action.Hover)))
    for vehicle <- settings.fleet.agents do
      assert(recording.solved.exists(one => one.vehicle == vehicle.name && one.receivedAt < lost))
      assert(recording.solved.exists(one => one.vehicle == vehicle.name && one.receivedAt > back))
    assert(times(EventKind.SolverRestarted).nonEmpty)
    val again = RecordedPlan.of(recording).fold(fail(_), identity)
    assertEquals(Replay(again.fleet, recording).firstDifference, None)
