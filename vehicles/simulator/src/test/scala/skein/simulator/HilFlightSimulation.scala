package skein.simulator

import java.security.MessageDigest
import java.util.HexFormat
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.ExecutionContext
import skein.hil.{AutopilotKind, SmallAutopilot}
import skein.link.*
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime

object HilFlightSimulation:
  /** The result of a flight: all bytes sent to the autopilot, as a digest, and the vehicle's true position at
    * the end.
    */
  final case class Flight(
      digest: String,
      positionNed: Vector3,
      sensors: Int,
      seconds: Double,
      stats: PeerStats
  )

  /** Runs the server, PX4's interface and a small autopilot behind it, in virtual time.
    *
    * @param speed rate of the simulator's clock relative to virtual time
    * @param link the link between the two
    */
  def fly(seed: Long, lasting: Span, speed: Double = 1, link: LinkProfile = LinkProfile.none): Flight =
    val began          = System.nanoTime()
    val digest         = MessageDigest.getInstance("SHA-256")
    val autopilot      = SmallAutopilot()
    val (truth, stats) = VirtualTime
      .run(seed): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = VirtualClock(system)
        val network            = MemoryNetwork(NetworkPlan(link), seed, clock)
        val settings           = SimulatorSettings(
          address = Address("simulator", 41451),
          speed = speed,
          hil = Some(HilSettings.usual(AutopilotKind.Px4, 1, "simulator").copy(seed = seed))
        )
        for
          server <- SimulatorServer.start(settings, network.host("simulator"), clock)
          _      <- HilPeer.fly(
            autopilot,
            lasting.toNanos / 1000,
            server.peerAddresses.head,
            network.host("autopilot")
          )(digest.update)
          truth <- server.truth()
          _     <- server.close()
        yield (truth, server.peerStats)
      .value
    Flight(
      HexFormat.of().formatHex(digest.digest()),
      truth.vehicles.head.kinematics.positionNed,
      autopilot.heard.size,
      (System.nanoTime() - began) * 1e-9,
      stats
    )

/** PX4's interface behind its server, in virtual time. */
class HilFlightSimulation extends munit.FunSuite, Unhurried:
  import HilFlightSimulation.*

  test("a small autopilot flies over the served interface in lockstep, and equal seeds give equal bytes"):
    val first = fly(1, Span.ofSeconds(20))
    assertEquals(first.sensors, 20 * 250)
    assert((first.positionNed - Vector3(0, 0, -5)).norm < 1.5, first.positionNed.toString)
    assertEquals(first.stats, PeerStats())
    val again = fly(1, Span.ofSeconds(20))
    assertEquals((again.digest, again.positionNed), (first.digest, first.positionNed))
    assert(fly(2, Span.ofSeconds(1)).digest != fly(3, Span.ofSeconds(1)).digest, "other seeds, other noise")

  test("an autopilot with a long delay hovers: physics waits for its answer to the newest sensors"):
    val far   = LinkProfile.symmetric(LatencyProfile.parse("constant:400ms", Left(_)).toOption.get)
    val there = fly(1, Span.ofSeconds(12), link = far)
    assert((there.positionNed - Vector3(0, 0, -5)).norm < 1.5, there.positionNed.toString)
    assertEquals(there.stats, PeerStats())
