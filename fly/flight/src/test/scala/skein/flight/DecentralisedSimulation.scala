package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.link.{MemoryNetwork, NetworkPlan}
import skein.loop.learning.Learning
import skein.loop.{FlightOutcome, Knowledge, LoopKind, Strangers}
import skein.measure.{PredictionErrors, RoundTripTrace}
import skein.policy.Role
import skein.record.{DecisionRow, MemoryRecorder, Recording}
import skein.scenario.{PaperDuel, Scenario, Scenarios, Shadow, Surround}
import skein.settings.{ChosenPolicy, FlySettings, PolicyFile}
import skein.signal.LatencyProfile
import skein.testing.{Optimised, TemporaryFolders}
import skein.units.*
import skein.vtime.VirtualTime

/** Flights in virtual time in which each vehicle has a controller of its own. */
class DecentralisedSimulation extends munit.FunSuite, TemporaryFolders, Optimised:
  private given Scenarios = Scenarios.ours

  private val loops = List(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive)

  private def settings(
      loop: LoopKind,
      link: LatencyProfile = LatencyProfile.vpn,
      scenario: Scenario = PaperDuel(),
      seconds: Int = 4
  ) = FlySettings(
    List(loop),
    List(link),
    duration = Span.ofSeconds(seconds),
    period = Span.ofMillis(100),
    seed = 1,
    scenario = scenario,
    decentralised = true
  )

  private def fly(settings: FlySettings, seed: Long = 1): MemoryRecorder =
    val flown = VirtualFlights.fly(settings, settings.plans.head.copy(seed = seed)).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    flown.recorder

  /** The decisions, with their times and states, but without the readings' sequence numbers and the commands
    * to other vehicles, which only a single controller knows.
    */
  private def decisions(recording: Recording): Vector[DecisionRow] = recording.decisions
    .sortBy(made => (made.vehicle, made.sequence))
    .map: made =>
      made.copy(
        own = made.own.copy(sequence = 0),
        opponent = made.opponent.copy(sequence = 0),
        opponentHeading = Radians(0),
        relativeX = Metres(0),
        relativeY = Metres(0),
        observations = made.observations.copy(sinceOpponentMove = None)
      )

  for (loop, scenario) <- loops.map((_, PaperDuel())) :+ (LoopKind.Stream, Surround()) do
    test(
      s"${loop.label}, ${scenario.name}: without a link, controllers decide as one that knows only positions"
    ):
      val apart  = settings(loop, LatencyProfile.none, scenario)
      val single = decisions(fly(apart.copy(decentralised = false, knows = Knowledge.Positions)).recording)
      assertEquals(decisions(fly(apart).recording), single)

  test("paused has one controller, which decides without knowledge of the others' commands"):
    val paused = settings(LoopKind.Paused, LatencyProfile.none)
    assertEquals(
      fly(paused).digest,
      fly(paused.copy(decentralised = false, knows = Knowledge.Positions)).digest
    )

  for loop <- loops do
    folder.test(
      s"${loop.label}: equal seeds give equal flights, different seeds do not, and a recording replays"
    ): folder =>
      // In two duels a decision's opponent depends on readings that it does not record.
      val flight = settings(loop, scenario = PaperDuel(pairs = 2))
      val flown  = fly(flight)
      assertNotEquals(fly(flight, seed = 2).digest, flown.digest)
      val file = flight.plans.head.file(folder)
      assert(flown.writeTo(file).isRight)
      val replayed = Replayed.of(file).fold(fail(_), identity)
      assertEquals((replayed.decidedAgain, replayed.isSame), (None, true))

  folder.test("others predicted by belief: a flight repeats to the bit, and its recording replays"): folder =>
    val flight = settings(LoopKind.Predictive, scenario = Shadow()).copy(strangers = Strangers.Belief)
    val flown  = fly(flight)
    assertEquals(fly(flight).digest, flown.digest)
    assertNotEquals(fly(flight.copy(strangers = Strangers.Turn)).digest, flown.digest)
    val file = flight.plans.head.file(folder)
    assert(flown.writeTo(file).isRight)
    val replayed = Replayed.of(file).fold(fail(_), identity)
    assertEquals((replayed.decidedAgain, replayed.isSame), (None, true))

  for loop <- loops do
    test(s"${loop.label}: a decision uses its own controller's readings, and their ages"):
      val recording = fly(settings(loop, scenario = Surround())).recording
      val names     = recording.heading.vehicles.map(_.name)
      val known     = recording.readings.map(read => (read.vehicle, read.sequence)).toSet
      assertEquals(known.size, recording.readings.size, "readings share a number")
      assertEquals(recording.decisions.map(_.vehicle).toSet, names.toSet)
      for made <- recording.decisions do
        val used = Seq(made.own, made.opponent)
        assertEquals(used.map(_.sequence % names.size).toSet, Set(names.indexOf(made.vehicle).toLong))
        assert(used.forall(read => known((read.vehicle, read.sequence))))
        assertEquals(
          Seq(made.observations.ownAge, made.observations.opponentAge),
          used.map(read => made.decidedAt.since(read.state.receivedAt))
        )
        // The simulator's clock is the controller's here.
        for age <- made.trueAge do
          val offMs = age.own.toMillis - made.decidedAt.since(made.own.state.validAt).toMillis
          assert(offMs.abs <= age.uncertainty.toMillis, s"off by $offMs of ${age.uncertainty.toMillis} ms")

  test("each controller has its own delays, and a fit of the link finds each controller's trace"):
    val recording = fly(settings(LoopKind.Stream)).recording
    val traces    = RoundTripTrace.of(recording)
    assertEquals(traces.size, 4)
    assertEquals(traces.flatMap(_.lost).count(identity), 0)
    // Only the first ones, before any command: later, the connections' traffic differs.
    assertEquals(traces.map(_.roundTripsMs.head).distinct.size, 4)

  for inPacket <- Seq(false, true) do
    test(
      s"a controller predicts its own vehicle by its model, others from their readings; in packets: $inPacket"
    ):
      val flown = fly(settings(LoopKind.Predictive, seconds = 20).copy(planInPacket = inPacket))
      val found = PredictionErrors.of(flown.recording, isDuel = true).get

      def p95M(of: PredictionErrors) = of.samples.map(_._2).sorted.apply(of.samples.size * 95 / 100)
      assert(p95M(found.own) < 0.01, s"own ${p95M(found.own)} m")
      assert(p95M(found.others) > 0.01, s"others ${p95M(found.others)} m")

  test("a single learner for all, and vehicles behind a single connection, are refused in a line"):
    val flight   = settings(LoopKind.Stream)
    val learning = ChosenPolicy("own", PolicyFile.paperOf(Role.Pursuer), Some(Learning.Again(0, Map.empty)))
    assertEquals(
      VirtualFlights.fly(flight, flight.plans.head.copy(policy = Some(learning))).map(_ => ()),
      Left("decentralised: expected policies that do not learn in flight, which is one learner for all")
    )
    object Topics extends VehicleSource:
      def where: String               = "ROS 2"
      def open(names: Vector[String]) = Future.never
    val started = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        val host               = MemoryNetwork(NetworkPlan(), 1, clock).host("localhost")
        val assembler = FlightAssembler(host, clock, flight, simulator = None, elsewhere = Some(Topics))
        val plan      = flight.plans.head
        assembler.start(plan, MemoryRecorder(assembler.heading(plan, "virtual"))).map(_.map(_ => ()))
      .value
    assertEquals(
      started,
      Left("decentralised: expected vehicles over AirSim's protocol, got those of ROS 2")
    )
