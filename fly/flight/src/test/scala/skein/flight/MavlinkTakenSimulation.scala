package skein.flight

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import skein.airsim.{Vehicles, WorldSettings}
import skein.link.*
import skein.loop.{FlightOutcome, LoopKind}
import skein.measure.FlightSummary
import skein.offboard.{MavlinkLink, MavlinkVehicle}
import skein.record.*
import skein.scenario.Scenarios
import skein.settings.{FlySettings, Wire}
import skein.signal.LatencyProfile
import skein.simulator.{MavlinkSettings, SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime

/** Flights over MAVLink with a second ground station. */
class MavlinkTakenSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = Scenarios.ours

  private val settings = FlySettings(
    List(LoopKind.Stream),
    List(LatencyProfile.none),
    duration = Span.ofSeconds(16),
    period = Span.ofMillis(100),
    seed = 1,
    wire = Wire.Mavlink
  )

  /** A flight with a second ground station of one of its vehicles, which acts after 5 s. */
  private def flown(acts: MavlinkVehicle => Future[Any]): (FlightOutcome, Recording) = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock   = Clock.ofNanos(VirtualTime.clock(system))
      val network = MemoryNetwork(NetworkPlan(LinkProfile.symmetric(LatencyProfile.none)), 1, clock)
      val duel    = settings.fleet.agents.map(Vehicles.settings)
      val world   = SimulatorSettings(
        WorldSettings.of(duel),
        Address("simulator", 41451),
        mavlink = Some(MavlinkSettings(listen = Some(Address("simulator", 5760))))
      )
      val controller = network.host("controller")
      for
        server <- SimulatorServer.start(world, network.host("simulator"), clock)
        at        = server.peerAddresses.head
        assembler = FlightAssembler(controller, clock, settings, Some(at), isMavlinkByTcp = true)
        plan      = settings.plans.head
        memory    = MemoryRecorder(assembler.heading(plan, "virtual"))
        assembly <- assembler.start(plan, memory).map(_.fold(fail(_), identity))
        _        <- after(Span.ofSeconds(5).toDuration)(Future.unit)
        other    <- MavlinkLink
          .open(network.host("another").connect(at), Vector(2), clock)
          .map(_.fold(error => fail(error.message), identity))
        _      <- acts(MavlinkVehicle(other, 2))
        landed <- assembly.landed
        _      <- other.close()
        _      <- server.close()
      yield (landed.outcome, memory.recording)
    .value

  test("another ground station that stops a vehicle's motors ends the flight without result"):
    val (outcome, recording) = flown(_.kill())
    val taken                = recording.events.filter(_.kind == EventKind.VehicleTaken)
    assertEquals(
      taken.map(_.detail),
      Vector("Pursuer is no longer this flight's: system 2 is disarmed")
    )
    assertEquals(outcome, FlightOutcome.Failed(taken.head.detail))
    assert(FlightSummary.of(recording).noResult.isDefined)

  test("a ground station that only listens does not end the flight"):
    val (outcome, recording) = flown(_.read())
    assertEquals(outcome, FlightOutcome.Completed)
    assertEquals(recording.events.filter(_.kind == EventKind.VehicleTaken), Vector.empty)
