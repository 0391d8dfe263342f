package skein.observe

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.util.ByteString
import scala.collection.mutable
import skein.airsim.{Vehicles, WorldSettings}
import skein.flight.FlightAssembler
import skein.link.*
import skein.mavlink.*
import skein.loop.LoopKind
import skein.record.MemoryRecorder
import skein.settings.{FlySettings, Wire}
import skein.signal.LatencyProfile
import skein.simulator.{MavlinkSettings, SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime

/** A loop of ours flies over MAVLink through the observer, in virtual time; the ages that the observer
  * reports are compared with those on the simulator's own clock.
  */
class MavlinkLoopSimulation extends munit.FunSuite, Unhurried:
  private val settings = FlySettings(
    List(LoopKind.Stream),
    List(LatencyProfile.none),
    duration = Span.ofSeconds(20),
    period = Span.ofMillis(90),
    seed = 1,
    wire = Wire.Mavlink
  )

  /** Knows when the vehicles were switched on, and computes the ages by that.
    *
    * @param bootAt time of the vehicles' start, on the observer's clock
    */
  private final class Truth(loop: MavlinkLoop, bootAt: Instant) extends Analysis[ObservedTopics]:
    private val newest  = mutable.HashMap.empty[Int, Long]
    private val readers = Map(true -> FrameReader(), false -> FrameReader())
    val agesMs          = mutable.ArrayBuffer.empty[Option[Double]]
    export loop.{closed, observed, opened, passedOver, progress, takeNew}

    def passed(connection: Int, isFromClient: Boolean, bytes: ByteString, at: Instant): Unit =
      loop.passed(connection, isFromClient, bytes, at)
      if connection > 0 then
        for frame <- readers(isFromClient).read(bytes.toArrayUnsafe()) do
          def sampled(ms: Long) = newest(frame.system) = ms.max(newest.getOrElse(frame.system, 0))
          frame.message match
            case local: LocalPositionNed             => sampled(local.timeBootMs)
            case global: GlobalPositionInt           => sampled(global.timeBootMs)
            case odometry: Odometry                  => sampled(odometry.timeUsec / 1000)
            case setpoint: SetPositionTargetLocalNed =>
              agesMs += newest.get(setpoint.targetSystem).map(ms =>
                at.since(bootAt + Span.ofMillis(ms.toDouble)).toMillis
              )
            case _ => ()

  private def flown(profile: LatencyProfile): (ObservedTopics, Vector[Option[Double]]) = VirtualTime
    .run(seed = 3): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock   = Clock.ofNanos(VirtualTime.clock(system))
      val network = MemoryNetwork(NetworkPlan(LinkProfile.symmetric(LatencyProfile.none)), 1, clock)
      val world   = SimulatorSettings(
        WorldSettings.of(settings.fleet.agents.map(Vehicles.settings)),
        Address("simulator", 41451),
        mavlink = Some(MavlinkSettings(listen = Some(Address("simulator", 5760))))
      )
      val controller = network.host("controller")
      val truth      = Truth(MavlinkLoop(isDatagrams = false), clock.now())
      for
        server <- SimulatorServer.start(world, network.host("simulator"), clock)
        proxy  <- ObservingProxy.start(
          truth,
          Address("controller", 5761),
          server.peerAddresses.head,
          EmulatedLink(LinkProfile.symmetric(profile), 3, clock),
          controller,
          clock,
          system.dispatcher,
          reason => fail(reason.getMessage)
        )
        assembler = FlightAssembler(controller, clock, settings, Some(proxy.address), isMavlinkByTcp = true)
        plan      = settings.plans.head
        memory    = MemoryRecorder(assembler.heading(plan, "virtual"))
        assembly <- assembler.start(plan, memory).map(_.fold(fail(_), identity))
        _        <- assembly.landed
        _        <- proxy.close()
        _        <- server.close()
      yield (proxy.observed, truth.agesMs.toVector)
    .value

  for profile <- Seq(LatencyProfile.direct, LatencyProfile.vpn) do
    test(
      s"over ${profile.name}, observed ages equal the simulator's ages within their bounds"
    ):
      val (observed, ages) = flown(profile)
      // The first connection brings the vehicles to their starts; the last is the connection of the flight.
      val compared = observed.log.takeRight(ages.size).zip(ages)
      assert(compared.size > 400, compared.size)
      val errorsMs =
        for (command, truth) <- compared; ms <- truth yield
          val errorMs = math.abs(command.ownAgeMs.get - ms)
          // Stamps are in whole milliseconds.
          assert(errorMs <= command.boundMs.get + 1, s"$command, is $ms ms old")
          errorMs
      assert(clue(errorsMs.sum / errorsMs.size) < 3)
      assertEquals(observed.byOtherClock, Vector.empty)
      assertEquals(observed.notKept, 0L)
