package skein.loop

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.flow.Hold
import skein.policy.{Action, HeadingPolicy, Role}
import skein.port.{VehicleError, VehiclePort}
import skein.record.{MemoryRecorder, Recording, Samples}
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.testing.Optimised
import skein.units.*
import skein.vtime.VirtualTime

/** The paper's duel with a controller for each vehicle; the vehicles record which controllers call them. */
class OwnControllersSimulation extends munit.FunSuite, Optimised:

  /** A vehicle as one controller reaches it. */
  private final class Watched(port: VehiclePort) extends VehiclePort:
    var reads, moves, hovers = 0
    var isHovering           = false

    def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
      reads += 1
      port.read()

    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
      moves += 1
      isHovering = false
      port.act(action, lasts)

    def hover(): Future[Either[VehicleError, Boolean]] =
      hovers += 1
      isHovering = true
      port.hover()

  /** @param ports each controller's port of each vehicle */
  private final case class Flown(outcome: FlightOutcome, ports: Vector[Vector[Watched]], recording: Recording)

  /** @param failsAfter number of the pursuer's decisions after which its policy throws
    * @param held whether the flight is paused from 2 s to 4 s
    */
  private def fly(kind: LoopKind, failsAfter: Int = Int.MaxValue, held: Boolean = false): Flown = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem                     = system
      given ExecutionContext                = system.dispatcher
      val clock                             = Clock.ofNanos(VirtualTime.clock(system))
      val duel                              = PaperDuel().fleet
      var decisions                         = 0
      val failing: HeadingPolicy.Memoryless = seen =>
        decisions += 1
        if decisions > failsAfter then throw IllegalStateException("no idea") else seen.ownHeadingRad
      val fleet = duel.copy(agents = duel.agents.map: agent =>
        if agent.role == Role.Pursuer then agent.copy(policy = failing) else agent)
      val world    = FarQuadrotors(fleet, LatencyProfile.vpn, 1, clock)
      val recorder = MemoryRecorder(Samples.heading)
      val hold     = Hold()
      val ports    = fleet.agents.map(_ => world.ports.map(Watched(_)))
      val teams    = ports.zipWithIndex.map: (seen, self) =>
        Team(
          fleet,
          seen,
          clock,
          recorder,
          LoopSettings(knows = Knowledge.Positions),
          only = Some(self),
          hold = hold
        )
      if held then
        for (after, act) <- Seq[(Int, () => Any)](2 -> (() => hold.hold()), 4 -> (() => hold.release())) do
          system.scheduler.scheduleOnce(Span.ofSeconds(after).toDuration)(act(): Unit): Unit
      Flight
        .start(kind, teams.head, None, Span.ofSeconds(6), clock, recorder, others = teams.tail)
        .outcome
        .map(Flown(_, ports, recorder.recording))
    .value

  private def assertEachByItsOwn(flown: Flown): Unit =
    for (seen, controller) <- flown.ports.zipWithIndex; (port, vehicle) <- seen.zipWithIndex do
      assert(port.reads > 10, s"$controller read $vehicle ${port.reads} times")
      if vehicle == controller then
        assert(port.moves > 5, s"$vehicle was moved ${port.moves} times")
        assert(port.isHovering, s"$vehicle flies on")
      else assertEquals((port.moves, port.hovers), (0, 0), s"$controller commanded $vehicle")

  for kind <- Seq(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive) do
    test(s"${kind.label}: all controllers read a vehicle, and its own one commands it until it hovers"):
      val flown = fly(kind)
      assertEquals(flown.outcome, FlightOutcome.Completed)
      assertEachByItsOwn(flown)

    test(s"${kind.label}: a controller that fails ends the flight with its name, and all vehicles hover"):
      val flown = fly(kind, failsAfter = 10)
      flown.outcome match
        case FlightOutcome.Failed(why) =>
          assert(clue(why).startsWith("the controller of Pursuer: the policy of Pursuer failed: "))
          assert(why.contains("no idea"), why)
        case other => fail(s"expected a failure, got $other")
      assertEachByItsOwn(flown)

  test("while a flight is paused, no controller decides"):
    val decided = fly(LoopKind.Stream, held = true).recording.decisions
    val start   = decided.map(_.decidedAt).min
    val seconds =
      decided.map(made => (made.vehicle, made.decidedAt.since(start).toSeconds)).groupMap(_._1)(_._2)
    assertEquals(seconds.keySet, Set("Pursuer", "Evader"))
    for (vehicle, times) <- seconds do
      assert(times.exists(_ < 1.8) && times.exists(_ > 4), vehicle)
      assert(!times.exists(time => time > 2 && time < 3.8), s"$vehicle: ${times.mkString(", ")}")
