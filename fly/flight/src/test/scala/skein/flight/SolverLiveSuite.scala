package skein.flight

import java.net.{InetAddress, ServerSocket}
import java.util.concurrent.ConcurrentLinkedQueue
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.link.{Address, TcpTransport}
import skein.loop.{LoopKind, FlightOutcome, PlanSettings, Replay}
import skein.policy.Action
import skein.record.EventKind
import skein.scenario.Scenarios
import skein.settings.{RecordedPlan, SolverChoice}
import skein.solver.*
import skein.testing.{Conclusive, Optimised}
import skein.units.*

/** A solver behind real sockets on loopback. */
class SolverLiveSuite extends munit.FunSuite, Optimised, Conclusive:
  private given system: ActorSystem = ActorSystem("SolverLiveSuite")
  private given Scenarios           = Scenarios.ours
  import system.dispatcher

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private def served(id: Long, at: Address): Future[SolverServer] =
    SolverServer.start(at, TcpTransport(), SolvedFlight.desk(id), Clock.system)

  test("a solver's plans arrive within the deadline, and replay"):
    conclusive:
      val server = Await.result(served(1, Address("127.0.0.1", 0)), 10.seconds)
      val flight = SolvedFlight(
        SolverChoice.Tcp(server.address),
        TcpLink(TcpTransport(), server.address),
        LoopKind.Plan,
        duration = Span.ofSeconds(5),
        changed = _.copy(
          deadline = Some(Span.ofMillis(600)),
          // A slice is searched in that time on a busy machine, too.
          planning = PlanSettings(Span.ofMillis(200), horizonSteps = 10, searches = 1, blocksPerSlice = 1)
        )
      )
      val flown = flight.flown().flatMap(outcome => server.close().map(_ => outcome))
      assertEquals(Await.result(flown, 60.seconds), FlightOutcome.Completed)
      val recording = flight.recorder.recording
      assert(recording.planned.sizeIs > 5, recording.planned.size)
      assert(recording.planned.exists(_.candidates > 0))
      for one <- recording.solved if one.vehicle == "Pursuer" do
        assert(one.thinking >= flight.settings.planning.deadline, one)
      val again = RecordedPlan.of(recording).fold(fail(_), identity)
      assertEquals(Replay(again.fleet, recording, again.settings.loopSettings).firstDifference, None)

  test(
    "a peer that accepts the connection and sends nothing is reported long before patience ends"
  ):
    // Connections in the backlog are established without being accepted.
    Using.resource(ServerSocket(0, 8, InetAddress.getLoopbackAddress)): silent =>
      val at     = Address("127.0.0.1", silent.getLocalPort)
      val link   = TcpLink(TcpTransport(), at, answerWithin = Span.ofMillis(200))
      val said   = ConcurrentLinkedQueue[String]()
      val flight = SolvedFlight(
        SolverChoice.Tcp(at),
        link,
        patience = Span.ofSeconds(600),
        toldAfter = Span.ofMillis(1),
        tell = said.add(_): Unit
      )
      val why = Await.result(flight.start(), 30.seconds).swap.getOrElse(fail("it was flown"))
      assert(clue(why).endsWith(
        s"who listens at $at takes the connection, but has said nothing for 0.20 s; expected ./skein decide there"
      ))
      assert(clue(said.asScala.toSeq).head.contains(s"waits for --solver tcp://$at, 600 s at most: "))

  test("if a solver is restarted in flight, vehicles hover, then fly on, and the flight replays"):
    val first  = Await.result(served(1, Address("127.0.0.1", 0)), 10.seconds)
    val at     = first.address
    val flight = SolvedFlight(
      SolverChoice.Tcp(at),
      TcpLink(TcpTransport(), at),
      LoopKind.Predictive,
      duration = Span.ofSeconds(5)
    )
    val flown =
      for
        started <- flight.start()
        _       <- after(1500.millis, system.scheduler)(first.close())
        second  <- after(1.second, system.scheduler)(served(2, at))
        landed  <- started.fold(fail(_), _.landed)
        _       <- second.close()
      yield landed.outcome
    assertEquals(Await.result(flown, 60.seconds), FlightOutcome.Completed)
    val recording              = flight.recorder.recording
    def times(kind: EventKind) = recording.events.filter(_.kind == kind).map(_.at)
    val (lost, back)           = (times(EventKind.Disconnected).head, times(EventKind.Reconnected).head)
    assert(recording.decisions.exists(made => made.decidedAt > lost && made.action.contains(Action.Hover)))
    for vehicle <- flight.settings.fleet.agents do
      assert(recording.solved.exists(one => one.vehicle == vehicle.name && one.receivedAt < lost))
      assert(recording.solved.exists(one => one.vehicle == vehicle.name && one.receivedAt > back))
    assert(times(EventKind.SolverRestarted).nonEmpty)
    val again = RecordedPlan.of(recording).fold(fail(_), identity)
    assertEquals(Replay(again.fleet, recording).firstDifference, None)
