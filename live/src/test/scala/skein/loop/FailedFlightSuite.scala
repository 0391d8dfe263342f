package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.{ExecutionContext, Future}
import skein.link.Clock
import skein.policy.{Policy, Role, Scenario}
import skein.record.{MemoryRecorder, Recording, Samples}
import skein.rpc.RpcError
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.units.*
import skein.vtime.VirtualTime

/** What becomes of the vehicles when a stage of the loop fails, here by a policy that throws. */
class FailedFlightSuite extends munit.FunSuite:
  private val lost = Left(RpcError.Timeout("hover", Span.ofMillis(500)))

  /** Counts what is outstanding; its first hovers are lost, and moves end by themselves, too. */
  private final class Counted(craft: Craft, lostHovers: Int)(using system: ActorSystem) extends Craft:
    import system.dispatcher
    private var outstanding, hovers = 0
    var mostOutstanding             = 0
    var hovering                    = false

    def isAnswered: Boolean = outstanding == 0

    private def counted[A](call: => Future[A]): Future[A] =
      outstanding += 1
      mostOutstanding = mostOutstanding.max(outstanding)
      call.andThen(_ => outstanding -= 1)

    def read(): Future[Either[RpcError, Stamped[Kinematics]]] = craft.read()

    def move(velocityNed: Vector3, down: Metres, duration: Span): Future[Either[RpcError, Boolean]] =
      hovering = false
      val flown = after(duration.toDuration, system.scheduler)(Future.successful(Right(true)))
      counted(Future.firstCompletedOf(Seq(craft.move(velocityNed, down, duration), flown)))

    def hover(): Future[Either[RpcError, Boolean]] =
      hovers += 1
      if hovers <= lostHovers then Future.successful(lost)
      else
        hovering = true
        counted(craft.hover())

  private final case class Landed(outcome: Outcome, crafts: Vector[Counted], recording: Recording)

  /** Both vehicles decide some 20 times, then the pursuer's policy throws. */
  private def fly(kind: LoopKind, error: => Throwable, lostHovers: Int = 0): Landed = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val duel               = Scenario.duel()
      var decisions          = 0
      val failing: Policy    = (_, _, _, _, own, _, _) =>
        decisions += 1
        if decisions > 20 then throw error else own
      val scenario = duel.copy(agents = duel.agents.map: agent =>
        if agent.role == Role.Pursuer then agent.copy(policy = failing) else agent)
      val world    = FarQuadrotors(scenario, LatencyProfile.vpn, 1, clock)
      val crafts   = world.crafts.map(Counted(_, lostHovers))
      val recorder = MemoryRecorder(Samples.heading)
      val team     = Team(scenario, crafts, clock, recorder, LoopSettings())
      Flight
        .start(kind, team, world, Span.ofSeconds(30), clock, recorder)
        .outcome
        .map(Landed(_, crafts, recorder.recording))
    .value

  for kind <- LoopKind.values.toSeq if kind != LoopKind.Plan do
    test(
      s"${kind.label}: when a policy throws, vehicles are told to hover until they say so, and every call ends"
    ):
      val landed = fly(kind, IllegalStateException("no idea"), lostHovers = 3)
      assertEquals(landed.outcome, Outcome.Failed("no idea"))
      for craft <- landed.crafts do
        assert(craft.hovering, "a vehicle flies on")
        assert(craft.isAnswered, "a call was outstanding at the end")
        assert(craft.mostOutstanding <= 2, s"${craft.mostOutstanding} commands were outstanding at once")

  test("an exception without a message is named by its class"):
    assertEquals(
      fly(LoopKind.Stream, ArithmeticException()).outcome,
      Outcome.Failed("java.lang.ArithmeticException")
    )

  test("vehicles that never say that they hover are given up and noted"):
    val landed = fly(LoopKind.Stream, IllegalStateException("no idea"), lostHovers = 999)
    val noted  = landed.recording.events.filter(_.detail.startsWith("not known to hover"))
    assertEquals(noted.flatMap(_.vehicle).toSet, Set("Pursuer", "Evader"))
