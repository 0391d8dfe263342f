package skein.flight

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future}
import skein.link.{Address, MemoryNetwork, NetworkPlan}
import skein.loop.{Fallback, LoopKind, FlightOutcome, PlanSettings, Replay}
import skein.policy.{PolicyFamily, Role}
import skein.record.EventKind
import skein.scenario.{Crossing, PaperDuel, Scenarios}
import skein.settings.{FlySettings, PolicyFile, PredictionModel, RecordedPlan, SolverChoice}
import skein.signal.LatencyProfile
import skein.solver.*
import skein.testing.Optimised
import skein.units.*
import skein.vtime.VirtualTime

/** Flights with a solver behind the emulated network, including protocol and connection. */
class SolverFlightSimulation extends munit.FunSuite, Optimised:
  private given Scenarios = Tilting.scenarios

  private val settings = FlySettings(
    List(LoopKind.Paused, LoopKind.Stream, LoopKind.Predictive),
    List(LatencyProfile.vpn),
    duration = Span.ofSeconds(4),
    period = Span.ofMillis(100),
    seed = 7,
    fallback = Fallback.Hover,
    solver = SolverChoice.parse("link:lognormal:8ms,0.5").toOption
  )

  test("every loop except paused has two flights with equal seeds: decided here, and by a solver"):
    assertEquals(
      settings.plans.map(_.id),
      Vector("paused-none", "stream-vpn", "predictive-vpn", "stream-vpn-solver", "predictive-vpn-solver")
    )
    assertEquals(settings.plans.filter(_.id.startsWith("stream")).map(_.seed).distinct.size, 1)

  test(
    "a flight with a solver is recorded with its round trips, replays, and repeats with an equal digest"
  ):
    for plan <- settings.plans.filter(_.solver.isDefined) do
      val flown     = VirtualFlights.fly(settings, plan).fold(fail(_), identity)
      val recording = flown.recorder.recording
      assertEquals(flown.landed.outcome, FlightOutcome.Completed)
      assert(recording.solved.size > 50, recording.solved.size)
      assertEquals(recording.solved.size, recording.decisions.size)
      assert(flown.landed.solverTrips.nonEmpty)
      val again = RecordedPlan.of(recording).fold(fail(_), identity)
      assertEquals(again.plan, plan)
      assertEquals(Replay(again.fleet, recording).firstDifference, None)
      val digest = VirtualFlights.fly(again.settings, again.plan).map(_.recorder.digest)
      assertEquals(digest, Right(flown.recorder.digest))

  test("over a link without delay, a solver's plans equal those of the flight's own process"):
    for
      scenario  <- Seq(PaperDuel(), Crossing(vehicles = 4))
      predictor <- Seq(PredictionModel.Quadrotor, Tilting.predictor)
    do
      val plans = settings.copy(
        loops = List(LoopKind.Plan),
        scenario = scenario,
        predictor = predictor,
        solver = SolverChoice.parse("link:none").toOption,
        planning = PlanSettings(horizonSteps = 10, searches = 2, slices = 2, blocksPerSlice = 1)
      )
      val Vector(here, there) = plans.plans.map(plan =>
        VirtualFlights.fly(plans, plan).fold(fail(_), identity).recorder.recording
      ): @unchecked
      assert(here.planned.size > 30, s"${here.planned.size} of ${scenario.name}")
      assertEquals(there.solved.size, there.decisions.size)
      assertEquals(there.decisions, here.decisions)
      assertEquals(there.planned, here.planned)
      assertEquals(there.readings, here.readings)
      val again = RecordedPlan.of(there).fold(fail(_), identity)
      assertEquals(Replay(again.fleet, there, again.settings.loopSettings).firstDifference, None)

  test("a solver without the plant of a flight's plans reports what it expected"):
    val plans = settings.copy(loops = List(LoopKind.Plan), predictor = Tilting.predictor)
    val asked = Briefing.of(plans, plans.plans.last)
    assert(Briefing.plan(asked).isRight)
    assertEquals(
      Briefing.plan(asked)(using Scenarios.ours).left.map(_.takeWhile(_ != ',')),
      Left("its parameter 'predictor': expected a model's name or five numbers")
    )

  test("without a configured deadline, a remote decision has the period for one"):
    val slow  = settings.copy(solver = SolverChoice.parse("link:constant:300ms").toOption)
    val flown = VirtualFlights.fly(slow, slow.plans.last).fold(fail(_), identity).recorder.recording
    assertEquals(flown.solved, Vector.empty)
    assert(flown.events.count(_.kind == EventKind.DeadlineMissed) > 50)
    assert(flown.events.count(_.kind == EventKind.LateReply) > 50)
    val timely = slow.copy(deadline = Some(Span.ofMillis(400)))
    val used   = VirtualFlights.fly(timely, timely.plans.last).fold(fail(_), identity).recorder.recording
    assert(used.solved.size > 10, used.solved.size)

  test("a flight sends a solver all data for equal decisions on an equal fleet"):
    val chosen = PolicyFile.ofDefaults(Role.Pursuer, PolicyFamily.paperPursuer)
    for flown <- Seq(settings, settings.copy(policies = List(chosen)), settings.copy(scenario = Crossing()))
    do
      val plan     = flown.plans.last
      val briefing = Briefing.of(flown, plan)
      val fleet    = Briefing.plan(briefing).fold(fail(_), identity).fleet
      assertEquals(Briefing.agents(fleet), briefing.agents)
      assertEquals(fleet, plan.fleet(flown))

  /** The answer of a solver of this build to a flight with a briefing.
    *
    * @param prepares duration of the solver's preparation
    */
  private def welcomed(
      briefing: Briefing,
      build: String = "ours",
      prepares: Span = Span.Zero
  ): Either[String, Done] =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        val network            = MemoryNetwork(NetworkPlan(), 1, clock)
        val at                 = Address("solver", 7400)
        val desk               = SolverDesk(
          1,
          "ours",
          Briefing.plan(_).flatMap(FlightDeciders.of(_, FlightAssembler.threads)),
          clock,
          Later(system, prepares)
        )
        for
          _ <- SolverServer.start(at, network.host("solver"), desk, clock)
          client =
            SolverClient(TcpLink(network.host("here"), at), 5, build, briefing, 2, clock, (_, _, _, _) => ())
          answer <- client.ready(Span.ofSeconds(3)).transform(result => scala.util.Success(result))
          _      <- client.close()
        yield answer.toEither.left.map(_.getMessage)
      .value

  test("a solver of another build, scenario or policy refuses, with the difference"):
    val briefing = Briefing.of(settings, settings.plans.last)
    assertEquals(welcomed(briefing), Right(Done))
    assertEquals(
      welcomed(briefing, build = "theirs"),
      Left(
        "the solver refuses: this solver is build ours, the flight's " +
          "program is build theirs; start both from the same program"
      )
    )
    val unknown = welcomed(briefing.copy(scenario = "moon landing"))
    assert(unknown.left.exists(_.startsWith("the solver refuses: ")), unknown)
    val other = welcomed(briefing.copy(agents = briefing.agents.map(_.replace("PaperPursuer", "Ambush"))))
    assert(other.left.exists(_.contains("the scenario is another here: the flight has Pursuer")), other)

  test("without a solver, a flight waits for its patience, and reports the address that it tried"):
    val run = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock   = Clock.ofNanos(VirtualTime.clock(system))
      val network = MemoryNetwork(NetworkPlan(), 1, clock)
      network.host("solver"): Unit
      val link     = TcpLink(network.host("here"), Address("solver", 7400))
      val briefing = Briefing.of(settings, settings.plans.last)
      val client   = SolverClient(link, 5, "ours", briefing, 2, clock, (_, _, _, _) => ())
      client.ready(Span.ofSeconds(3)).failed.flatMap(error => client.close().map(_ => error.getMessage))
    assertEquals(
      run.value,
      "no solver within 3 s: nobody listens at solver:7400; is the program there started?"
    )

  test("a flight waits for a solver that prepares, up to a limit"):
    val briefing = Briefing.of(settings, settings.plans.last)
    assert(welcomed(briefing, prepares = Span.ofSeconds(200)).isRight)
    assertEquals(
      welcomed(briefing, prepares = Span.ofSeconds(2000)).left.map(_.toString),
      Left("no solver within 600 s: the solver prepares for the flight, and has not finished")
    )

  test("a peer that sends garbage to a solver loses its connection, and flights continue"):
    val garbage =
      Seq("GET / HTTP/1.1\r\n\r\n", "\u0000\u0000\u0000\u0004abcd", "\u007f\u007f\u007f\u007f", "\u0000")
    val run = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock   = Clock.ofNanos(VirtualTime.clock(system))
      val network = MemoryNetwork(NetworkPlan(), 1, clock)
      val at      = Address("solver", 7400)
      val desk    = SolverDesk(
        1,
        "ours",
        Briefing.plan(_).flatMap(FlightDeciders.of(_, FlightAssembler.threads)),
        clock,
        system.dispatcher
      )
      for
        _ <- SolverServer.start(at, network.host("solver"), desk, clock)
        _ <- Future.traverse(garbage): text =>
          Source
            .single(ByteString(text, "ISO-8859-1"))
            .via(network.host("stranger").connect(at))
            .runWith(Sink.ignore)
            .recover(_ => org.apache.pekko.Done)
        client = SolverClient(
          TcpLink(network.host("here"), at),
          5,
          "ours",
          Briefing.of(settings, settings.plans.last),
          2,
          clock,
          (_, _, _, _) => ()
        )
        _ <- client.ready(Span.ofSeconds(3))
        _ <- client.close()
      yield desk.stats
    assertEquals(run.value.garbled, 1L)
    assertEquals(run.value.refused, 0L)

  test(
    "silent or slow strangers at a solver keep no flight out, and displace no useful peer"
  ):
    val word = ByteString(SolverMessageCodec.bytes(SolverMessage.Goodbye(5)))
    val said = ByteString(0, 0, 0, word.size.toByte) ++ word
    val run  = VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock                    = Clock.ofNanos(VirtualTime.clock(system))
      val network                  = MemoryNetwork(NetworkPlan(), 1, clock)
      val at                       = Address("solver", 7400)
      val desk                     = SolvedFlight.desk()
      def often(bytes: ByteString) = Source.tick(Duration.Zero, 300.millis, bytes)
      val kinds                    = Seq(
        Source.maybe[ByteString],
        Source.single(said).concat(Source.maybe),
        often(said),
        Source.single(ByteString(0, 0, 1, 0)).concat(often(ByteString(1)))
      )
      def strangers(count: Int): Unit = for number <- 0 until count do
        kinds(number % kinds.size).via(network.host("stranger").connect(at)).runWith(Sink.ignore): Unit
      var lost                 = 0
      def flight(number: Long) = SolverClient(
        TcpLink(network.host("here"), at),
        number,
        SolvedFlight.Build,
        Briefing.of(settings, settings.plans.last),
        2,
        clock,
        (kind, _, _, _) => if kind == EventKind.Disconnected then lost += 1
      )
      for
        server <- SolverServer.start(at, network.host("solver"), desk, clock)
        _ = strangers(SolverServer.MostConnections)
        _ <- after(1500.millis, system.scheduler)(Future.unit)
        first = flight(1)
        _ <- first.ready(Span.ofSeconds(3))
        _ = strangers(SolverServer.MostConnections)
        _ <- after(1500.millis, system.scheduler)(Future.unit)
        second = flight(2)
        _ <- second.ready(Span.ofSeconds(3))
        (stats, disconnected) = (desk.stats, lost)
        _ <- Future.traverse(Seq(first, second))(_.close())
      yield (
        stats.flights,
        disconnected,
        server.displacedConnections >= 65,
        server.refusedConnections < 64
      )
    assertEquals(run.value, (2, 0, true, true))

/** Runs every task after a fixed delay. */
private final class Later(system: ActorSystem, by: Span) extends ExecutionContext:
  def execute(work: Runnable): Unit =
    if by == Span.Zero then system.dispatcher.execute(work)
    else system.scheduler.scheduleOnce(by.toDuration, work)(using system.dispatcher): Unit
  def reportFailure(cause: Throwable): Unit = system.dispatcher.reportFailure(cause)
