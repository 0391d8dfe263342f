package skein.flight

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.*
import org.apache.pekko.stream.{ClosedShape, SharedKillSwitch}
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.loop.*
import skein.policy.Action
import skein.port.{Sensor, VehicleError, VehiclePort}
import skein.record.{ClockKind, MemoryRecorder}
import skein.scenario.{PaperDuel, Scenarios}
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.*
import skein.vtime.VirtualTime

/** A user's own loop: a graph of public operators. */
class OwnLoopSimulation extends munit.FunSuite, TemporaryFolders, Unhurried:

  /** A loop like `stream` without pacing: decides on everything new. */
  private val eager = OwnLoop("eager", (team, stop) => OwnLoopSimulation.eager(team, stop))

  private final class Counted(port: VehiclePort, hovers: () => Unit) extends VehiclePort:
    def read(): Future[Either[VehicleError, Stamped[Kinematics]]]               = port.read()
    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] = port.act(action, lasts)
    def hover(): Future[Either[VehicleError, Boolean]]                          =
      hovers()
      port.hover()
    override val sensors: Map[String, Sensor] = port.sensors

  private def fly(
      loop: OwnLoop,
      seed: Long = 1
  ): (outcome: FlightOutcome, recorder: MemoryRecorder, hovers: Int) =
    var hovers = 0
    val flown  = VirtualTime
      .run(seed): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        val scenario           = PaperDuel()
        val world              = FarQuadrotors(scenario.fleet, LatencyProfile.vpn, seed, clock)
        val flight             =
          PortFlight("own", loop, scenario, Span.ofSeconds(20), ClockKind.Virtual, clock, simulator = "far")
        val recorder = MemoryRecorder(flight.heading)
        val ports    = world.ports.map(Counted(_, () => hovers += 1))
        flight.start(ports, recorder).landed.map(landed => (landed.outcome, recorder))
      .value
    (flown._1, flown._2, hovers)

  private lazy val flown = fly(eager)

  test(
    "an own loop has equal recordings for equal seeds in virtual time, and a replay repeats its decisions"
  ):
    val recording = flown.recorder.recording
    assertEquals(flown.outcome, FlightOutcome.Completed)
    assertEquals(recording.flight.loop, "eager")
    assert(recording.decisions.size > 300, s"${recording.decisions.size} decisions")
    assertEquals(flown.recorder.digest, fly(eager).recorder.digest)
    assertEquals(Replay(PaperDuel().fleet, recording).firstDifference, None)

  test("a replay of an unknown loop's file repeats its decisions, but not its flight"):
    val file = temporaryFolder().resolve("eager.duckdb")
    assert(flown.recorder.writeTo(file).isRight)
    val replayed = Replayed.of(file)(using Scenarios.ours).fold(fail(_), identity)
    assertEquals((replayed.isSame, replayed.flownAgain), (true, None))

  test("vehicles hover at the end even if the graph does not command it"):
    val idle = OwnLoop(
      "idle",
      (team, stop) =>
        team.ticks(team.now).via(stop.flow).toMat(Sink.ignore)(Keep.right)
    )
    val landed = fly(idle)
    assertEquals((landed.outcome, landed.hovers), (FlightOutcome.Completed, 2))

  test("a graph that ignores the switch is aborted, and the vehicles hover"):
    val deaf   = OwnLoop("deaf", (team, _) => team.ticks(team.now).toMat(Sink.ignore)(Keep.right))
    val landed = fly(deaf)
    assertEquals(landed.hovers, 2)
    assert(landed.recorder.recording.events.exists(_.kind == skein.record.EventKind.Aborted))

  test("a graph whose future never completes is aborted, and the vehicles hover"):
    val mute = OwnLoop(
      "mute",
      (team, stop) =>
        team.ticks(team.now).via(stop.flow).to(Sink.ignore).mapMaterializedValue(_ => Promise[Done]().future)
    )
    val landed = fly(mute)
    assertEquals(landed.hovers, 2)
    assert(clue(
      landed.recorder.recording.events
    ).exists(_.detail.contains("the loop mute had not ended 30 s after")))

  test("a graph that cannot be built ends the flight as failed, and the vehicles hover"):
    val unbuilt = OwnLoop("unbuilt", (_, _) => throw IllegalArgumentException("an inlet is not connected"))
    val landed  = fly(unbuilt)
    assertEquals((landed.outcome, landed.hovers), (FlightOutcome.Failed("an inlet is not connected"), 2))

  test("a graph that fails ends the flight as failed"):
    val broken = OwnLoop(
      "broken",
      (_, _) =>
        Source.failed[Int](IllegalStateException("no such instrument")).toMat(Sink.ignore)(Keep.right)
    )
    val landed = fly(broken)
    assertEquals((landed.outcome, landed.hovers), (FlightOutcome.Failed("no such instrument"), 2))

  test("a user's own loop must have a name that no loop of Skein has, and that fits tables and files"):
    for name <- Seq("stream", "", "My loop", "a" * 41) do
      intercept[IllegalArgumentException](OwnLoop(name, (team, stop) => OwnLoopSimulation.eager(team, stop)))

object OwnLoopSimulation:
  private def eager(team: Team, stop: SharedKillSwitch): RunnableGraph[Future[Done]] =
    RunnableGraph.fromGraph(GraphDSL.createGraph(Sink.ignore) { implicit builder => end =>
      import GraphDSL.Implicits.*
      val readings = builder.add(Merge[(Int, Reading)](team.vehicles.size))
      val events   = builder.add(team.events(1))
      val cast     = builder.add(team.cast())
      val steered  = builder.add(team.steered)
      val fan      = builder.add(team.fan)
      val start    = team.now
      for vehicle <- team.vehicles do
        team.sense(vehicle, start).via(stop.flow).map((vehicle, _)) ~> readings
        cast ~> team.decide(vehicle) ~> team.newest(vehicle) ~> team.steer(vehicle) ~> steered
      readings ~> team.joinLatest ~> events.in(0)
      events ~> team.view ~> cast
      steered ~> fan
      fan ~> team.record
      fan ~> team.sent ~> team.feedBack ~> events.preferred
      fan ~> end
      ClosedShape
    })
