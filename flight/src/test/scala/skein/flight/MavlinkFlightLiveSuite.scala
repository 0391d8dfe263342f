package skein.flight

import java.net.{DatagramSocket, InetAddress}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.{Address, TcpTransport}
import skein.loop.{LoopKind, Outcome}
import skein.record.MemoryRecorder
import skein.settings.{FlySettings, Wire}
import skein.signal.LatencyProfile
import skein.simulator.*
import skein.testing.Waiting
import skein.units.*

/** A flight over MAVLink by UDP, with a simulator that runs already, as PX4's would; its clock runs faster, since the ways to
  * the starts are most of it.
  */
class MavlinkFlightLiveSuite extends munit.FunSuite, Waiting:
  private given system: ActorSystem = ActorSystem("mavlink-flight")

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private val settings = FlySettings(
    List(LoopKind.Stream),
    List(LatencyProfile.none),
    Span.ofSeconds(5),
    Span.ofMillis(100),
    seed = 1,
    wire = Wire.Mavlink
  )
  private val plan = settings.plans.head

  private def assembler(port: Int) =
    FlightAssembler(TcpTransport(), Clock.system, settings, Some(Address("127.0.0.1", port)))

  /** Begins where nobody is to be found while the other test flies. */
  private val unheard =
    val flying = assembler(9)
    flying.start(plan, MemoryRecorder(flying.heading(plan, "real")))

  test("the duel flies by datagrams: vehicles take off, come to their starts, and are flown to the end"):
    val port =
      val socket = DatagramSocket(0, InetAddress.getLoopbackAddress)
      try socket.getLocalPort
      finally socket.close()
    val vehicles = settings.fleet.agents.zipWithIndex.map((agent, index) =>
      VehicleSettings(agent.name, Vector3(0, 5 * index, 0))
    )
    val server = Await.result(
      SimulatorServer.start(
        SimulatorSettings(
          WorldSettings(vehicles),
          Address("127.0.0.1", 0),
          speed = 3,
          mavlink = Some(MavlinkSettings(udp = Vector(MavlinkPort(Address("127.0.0.1", port)))))
        ),
        TcpTransport(),
        Clock.system
      ),
      10.seconds
    )
    try
      val flying   = assembler(port)
      val recorder = MemoryRecorder(flying.heading(plan, "real"))
      val assembly = Await.result(flying.start(plan, recorder), 3.minutes).fold(fail(_), identity)
      val landed   = Await.result(assembly.landed, 1.minute)
      assertEquals(landed.outcome, Outcome.Completed)
      assert(recorder.recording.decisions.size > 60, s"${recorder.recording.decisions.size} decisions")
    finally
      val _ = Await.result(server.close(), 10.seconds)

  test("where nobody speaks MAVLink, the flight says so"):
    val why = Await.result(unheard, 1.minute)
    assert(why.left.exists(_.contains("expected MAVLink systems 1, 2")), why.toString)
