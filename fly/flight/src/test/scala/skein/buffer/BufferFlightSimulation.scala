package skein.buffer

import org.apache.pekko.actor.ActorSystem
import skein.airsim.{Vehicles, WorldSettings}
import skein.flight.{FlightAssembler, VirtualFlights}
import skein.link.*
import skein.loop.{FlightOutcome, LoopKind}
import skein.measure.FlightSummary
import skein.record.MemoryRecorder
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime

/** The paper's duel in virtual time, with plans in the packets, against a running simulator: once with the
  * simulator's own buffer, once with an external one.
  */
class BufferFlightSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = Scenarios.ours

  private val lossy =
    LatencyProfile.parse("loss:5%/4,outage:1s/10s,vpn", Left(_)).fold(_ => fail(""), identity)

  private val settings = FlySettings(
    List(LoopKind.Predictive),
    List(lossy),
    duration = Span.ofSeconds(60),
    period = Span.ofMillis(100),
    seed = 1,
    planInPacket = true
  )

  private def distanceM(recorder: MemoryRecorder): Double =
    FlightSummary.of(recorder.recording).headline.getOrElse(fail("no distance"))

  /** A flight's final distance, and the counts of the external buffer. */
  private def fly(isBeside: Boolean): (Double, BufferCounts) = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock    = Clock.ofNanos(VirtualTime.clock(system))
      val near     = LatencyProfile.parse("constant:1ms", Left(_)).fold(_ => fail(""), identity)
      val links    = Map(("beside", "simulator") -> LinkProfile.symmetric(near))
      val network  = MemoryNetwork(NetworkPlan(links = links), 1, clock)
      val (at, to) = (Address("simulator", 41451), Address("beside", 41452))
      val beside   = network.host("beside")
      val world    = WorldSettings.of(settings.fleet.agents.map(Vehicles.settings))
      val buffer   = SimulatorBuffer.start(at, beside, clock)
      val link     = EmulatedLink(LinkProfile.none, 1, clock)
      val plan     = settings.plans.head
      for
        server <- SimulatorServer.start(SimulatorSettings(world, at), network.host("simulator"), clock)
        proxy  <- LinkProxy.start(to, at, link, beside, beside = () => buffer.passing())
        assembler = FlightAssembler(beside, clock, settings, Some(if isBeside then to else at))
        recorder  = MemoryRecorder(assembler.heading(plan, "virtual"))
        flight <- assembler.start(plan, recorder).map(_.fold(fail(_), identity))
        landed <- flight.landed
        _      <- proxy.close()
        _      <- buffer.close()
        _      <- server.close()
      yield
        assertEquals(landed.outcome, FlightOutcome.Completed)
        (distanceM(recorder), buffer.counts)
    .value

  test(
    "through losses and outages, flights with an external buffer are as close to paused as with the built-in"
  ):
    val paused =
      settings.copy(loops = List(LoopKind.Paused), links = List(LatencyProfile.none), planInPacket = false)
    val truthM            = distanceM(VirtualFlights.fly(paused, paused.plans.head).fold(fail(_), _.recorder))
    val (ownM, _)         = fly(isBeside = false)
    val (besideM, counts) = fly(isBeside = true)
    assert(math.abs(besideM / truthM - 1) < 0.02, s"${100 * (besideM / truthM - 1)} % off the truth")
    assert(math.abs(besideM / ownM - 1) < 0.01, s"$besideM m, by the simulator's own buffer $ownM m")
    assert(counts.moves > 1000 && counts.plans > 800, counts.toString)
    assertEquals((counts.refusedPlans, counts.failedMoves, counts.lostConnections), (0L, 0L, 0L))
    assert(counts.latest < Span.ofMillis(3), counts.toString)
