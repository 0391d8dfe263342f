package skein.flight

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.link.{MemoryNetwork, NetworkPlan}
import skein.loop.{FlightOutcome, LoopKind}
import skein.measure.FlightSummary
import skein.policy.Action
import skein.port.{VehicleError, VehiclePort}
import skein.record.{CommandOutcome, EventKind, MemoryRecorder}
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.*
import skein.vtime.VirtualTime

/** The paper's duel in virtual time, with plans in the packets. */
class PlanInPacketSimulation extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given Scenarios = Scenarios.ours

  private def link(text: String) =
    LatencyProfile.parse(text, _ => fail("no file")).fold(e => fail(e.message), identity)

  private val lossy = link("loss:5%/4,outage:1s/10s,vpn")

  private def settings(link: LatencyProfile, seconds: Int = 60) = FlySettings(
    List(LoopKind.Predictive),
    List(link),
    duration = Span.ofSeconds(seconds),
    period = Span.ofMillis(100),
    seed = 1,
    planInPacket = true
  )

  private def fly(settings: FlySettings, seed: Long = 1): MemoryRecorder =
    val flown = VirtualFlights.fly(settings, settings.plans.head.copy(seed = seed)).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed, s"seed $seed")
    flown.recorder

  private def distanceM(flown: MemoryRecorder): Double =
    FlightSummary.of(flown.recording).headline.getOrElse(fail("no distance"))

  private lazy val truthM =
    val paused = settings(LatencyProfile.none).copy(loops = List(LoopKind.Paused), planInPacket = false)
    distanceM(fly(paused))

  test(
    "over 400 ms with two moves in flight, plans bring predictive from 20 % to within 2 % of paused"
  ):
    val far = settings(link("constant:400ms"))
    val off = distanceM(fly(far)) / truthM - 1
    assert(math.abs(off) < 0.02, s"${100 * off} %")
    val without = distanceM(fly(far.copy(planInPacket = false))) / truthM - 1
    assert(without > 0.15, s"without plans: ${100 * without} %")

  test("through losses and outages, flights complete within 2 % of paused"):
    val offs = Seq(1L, 5L).map: seed =>
      distanceM(fly(settings(lossy), seed)) / truthM - 1
    assert(offs.forall(off => math.abs(off) < 0.02), offs.toString)

  test("each command is answered once the buffer has it, and each period has one command"):
    val flown   = fly(settings(link("constant:400ms"), seconds = 5)).recording
    val answers = flown.acknowledgements.filter(_.vehicle == "Pursuer")
    val sentAt = flown.commands.filter(_.vehicle == "Pursuer").map(sent => sent.sequence -> sent.sentAt).toMap
    assert(answers.size > 40, s"${answers.size} answers in 5 s")
    assert(answers.forall(_.outcome == CommandOutcome.Done))
    assert(answers.forall(answer => answer.endedAt.since(sentAt(answer.command)) < Span.ofMillis(410)))

  folder.test("equal seeds give equal recordings, which replay"): folder =>
    val flight  = settings(lossy, seconds = 12)
    val flown   = fly(flight, seed = 3)
    val another = fly(flight, seed = 4)
    assertEquals(fly(flight, seed = 3).digest, flown.digest)
    assertNotEquals(another.digest, flown.digest)
    val file = flight.plans.head.file(folder)
    assert(flown.writeTo(file).isRight)
    val replayed = Replayed.of(file).fold(fail(_), identity)
    assertEquals((replayed.decidedAgain, replayed.isSame), (None, true))
    assert(flown.recording.events.exists(_.kind == EventKind.TimedOut), "no outage came")

  /** A vehicle that moves a little with each command, and accepts no plans. */
  private final class Plain(clock: Clock) extends VehiclePort:
    private var at = Vector3.Zero

    def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
      val now   = clock.now()
      val state = Kinematics(at, Vector3.Zero, Quaternion.Identity, Vector3.Zero)
      Future.successful(Right(Stamped(state, now, now, now)))

    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
      action match
        case Action.Velocity(velocityNed, _) => at = at + velocityNed * 0.1
        case _                               => ()
      Future.successful(Right(true))

    def hover(): Future[Either[VehicleError, Boolean]] = Future.successful(Right(true))

  test("a flight whose vehicles accept no plans is refused with a message that states what was expected"):
    val flight = settings(LatencyProfile.none)
    val result = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock  = Clock.ofNanos(VirtualTime.clock(system))
        val source = new VehicleSource:
          def where: String               = "our rovers"
          def open(names: Vector[String]) = Future.successful(
            Right(VehicleSource.Opened(
              names.map(_ => Plain(clock)),
              () => None,
              () => Future.successful(Done)
            ))
          )
        val host      = MemoryNetwork(NetworkPlan(), 1, clock).host("localhost")
        val assembler = FlightAssembler(host, clock, flight, simulator = None, elsewhere = Some(source))
        val plan      = flight.plans.head
        assembler.start(plan, MemoryRecorder(assembler.heading(plan, "virtual"))).map(_.map(_ => ()))
      .value
    assertEquals(
      result,
      Left(
        "plan-in-packet: expected a buffer of plans beside the vehicles, as the built-in simulator has and " +
          "`skein link --buffer` puts before AirSim, got our rovers: " +
          "plan 0: no buffer beside this vehicle holds plans"
      )
    )
