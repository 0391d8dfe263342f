package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.{ExecutionContext, Future}
import skein.policy.{Action, HeadingPolicy, Role}
import skein.port.{VehicleError, VehiclePort}
import skein.record.{MemoryRecorder, Recording, Samples}
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.units.*
import skein.vtime.VirtualTime

/** The fate of the vehicles when a stage of the loop fails, here by a policy that throws. */
class FailedFlightSuite extends munit.FunSuite:
  private val lost = Left(VehicleError.TimedOut("hover: no answer within 500 ms"))

  /** Counts unfinished calls. Its first hovers are lost, and its moves also end by themselves. */
  private final class Counted(port: VehiclePort, lostHovers: Int)(using system: ActorSystem)
      extends VehiclePort:
    import system.dispatcher
    private var outstanding, hovers = 0
    var mostOutstanding             = 0
    var outstandingAtHover          = 0
    var hovering                    = false

    def isAnswered: Boolean = outstanding == 0

    private def counted[A](call: => Future[A]): Future[A] =
      outstanding += 1
      mostOutstanding = mostOutstanding.max(outstanding)
      call.andThen(_ => outstanding -= 1)

    def read(): Future[Either[VehicleError, Stamped[Kinematics]]] = port.read()

    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
      hovering = false
      val flown = after(lasts.toDuration, system.scheduler)(Future.successful(Right(true)))
      counted(Future.firstCompletedOf(Seq(port.act(action, lasts), flown)))

    def hover(): Future[Either[VehicleError, Boolean]] =
      hovers += 1
      if hovers <= lostHovers then Future.successful(lost)
      else
        hovering = true
        outstandingAtHover = outstanding
        counted(port.hover())

  private final case class FlightResult(outcome: FlightOutcome, ports: Vector[Counted], recording: Recording)

  /** Both vehicles decide some 20 times, then the pursuer's policy throws. */
  private def fly(
      kind: LoopKind,
      error: => Throwable,
      lostHovers: Int = 0,
      link: LatencyProfile = LatencyProfile.vpn,
      settings: LoopSettings = LoopSettings()
  ): FlightResult = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem                     = system
      given ExecutionContext                = system.dispatcher
      val clock                             = Clock.ofNanos(VirtualTime.clock(system))
      val duel                              = PaperDuel().fleet
      var decisions                         = 0
      val failing: HeadingPolicy.Memoryless = seen =>
        decisions += 1
        if decisions > 20 then throw error else seen.ownHeadingRad
      val scenario = duel.copy(agents = duel.agents.map: agent =>
        if agent.role == Role.Pursuer then agent.copy(policy = failing) else agent)
      val world    = FarQuadrotors(scenario, link, 1, clock)
      val ports    = world.ports.map(Counted(_, lostHovers))
      val recorder = MemoryRecorder(Samples.heading)
      val team     = Team(scenario, ports, clock, recorder, settings)
      Flight
        .start(kind, team, Some(world), Span.ofSeconds(30), clock, recorder)
        .outcome
        .map(FlightResult(_, ports, recorder.recording))
    .value

  private def assertFailed(landed: FlightResult, reason: String): Unit = landed.outcome match
    case FlightOutcome.Failed(why) => assert(clue(why).startsWith(reason))
    case other                     => fail(s"expected a failure, got $other")

  for kind <- LoopKind.values.toSeq if kind != LoopKind.Plan do
    test(
      s"${kind.label}: when a policy throws, hovering is repeated until it is confirmed, and every call ends"
    ):
      val landed = fly(kind, IllegalStateException("no idea"), lostHovers = 3)
      assertFailed(landed, "the policy of Pursuer failed: java.lang.IllegalStateException: no idea (")
      for port <- landed.ports do
        assert(port.hovering, "a vehicle flies on")
        assert(port.isAnswered, "a call was outstanding at the end")
        assert(port.mostOutstanding <= 2, s"${port.mostOutstanding} commands were outstanding at once")

  test("an exception without a message is reported by its class"):
    assertFailed(
      fly(LoopKind.Stream, ArithmeticException()),
      "the policy of Pursuer failed: java.lang.ArithmeticException ("
    )

  test("vehicles that never confirm to hover are given up and recorded"):
    val landed = fly(LoopKind.Stream, IllegalStateException("no idea"), lostHovers = 999)
    val noted  = landed.recording.events.filter(_.detail.startsWith("not known to hover"))
    assertEquals(noted.flatMap(_.vehicle).toSet, Set("Pursuer", "Evader"))

  test("if two moves are unanswered when a flight fails, hovering waits until one of them has ended"):
    val landed = fly(LoopKind.Stream, IllegalStateException("no idea"), link = VirtualGame.constant(400))
    assertEquals(
      landed.ports.map(port => (port.hovering, port.mostOutstanding)),
      Vector.fill(2)((true, 2))
    )

  test("if six moves may be unanswered, hovering waits until all but one have ended"):
    val landed = fly(
      LoopKind.Stream,
      IllegalStateException("no idea"),
      link = VirtualGame.constant(800),
      settings = LoopSettings(movesInFlight = 6)
    )
    for port <- landed.ports do
      assert(port.mostOutstanding > 2, port.mostOutstanding.toString)
      assertEquals((port.hovering, port.outstandingAtHover), (true, 1))

  test("only paused needs a simulator whose time passes in steps"):
    def flown(kind: LoopKind): FlightOutcome = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        val duel               = PaperDuel().fleet
        val recorder           = MemoryRecorder(Samples.heading)
        val world              = FarQuadrotors(duel, LatencyProfile.none, 1, clock)
        val team               = Team(duel, world.ports, clock, recorder, LoopSettings())
        Flight.start(kind, team, None, Span.ofSeconds(1), clock, recorder).outcome
      .value
    assertEquals(flown(LoopKind.Stream), FlightOutcome.Completed)
    assert(intercept[IllegalArgumentException](flown(LoopKind.Paused)).getMessage.contains("paused needs"))
