package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{Await, Future}
import scala.concurrent.duration.*
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.*
import skein.loop.{LoopKind, FlightOutcome}
import skein.record.MemoryRecorder
import skein.settings.{FlySettings, Wire}
import skein.signal.LatencyProfile
import skein.simulator.*
import skein.testing.{Lengthy, Waiting}
import skein.units.*

/** Flights over MAVLink by UDP and by TCP, with a simulator that runs already, as PX4's would; its clock runs
  * faster, since the ways to the starts are most of it.
  */
class MavlinkFlightLiveSuite extends munit.FunSuite, Lengthy, Waiting:
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

  private def assembler(port: Int, isTcp: Boolean = false) = FlightAssembler(
    TcpTransport(),
    Clock.system,
    settings,
    Some(Address("127.0.0.1", port)),
    isMavlinkByTcp = isTcp
  )

  /** A flight that starts without a simulator while the other test runs. */
  private val unheard =
    val flying = assembler(9)
    flying.start(plan, MemoryRecorder(flying.heading(plan, "real")))

  /** Vehicles take off, reach their starts, and fly to the end. */
  private def flies(mavlink: MavlinkSettings, isTcp: Boolean = false)(
      reached: SimulatorServer => Future[Address]
  ): Unit =
    val vehicles = settings.fleet.agents.zipWithIndex.map((agent, index) =>
      VehicleSettings(agent.name, Vector3(0, 5 * index, 0))
    )
    val server = Await.result(
      SimulatorServer.start(
        SimulatorSettings(
          WorldSettings(vehicles),
          Address("127.0.0.1", 0),
          mavlink = Some(mavlink)
        ),
        TcpTransport(),
        Clock.system
      ),
      10.seconds
    )
    try
      val flying   = assembler(Await.result(reached(server), 10.seconds).port, isTcp)
      val recorder = MemoryRecorder(flying.heading(plan, "real"))
      val assembly = Await.result(flying.start(plan, recorder), 3.minutes).fold(fail(_), identity)
      val landed   = Await.result(assembly.landed, 1.minute)
      assertEquals(landed.outcome, FlightOutcome.Completed)
      assert(recorder.recording.decisions.size > 60, s"${recorder.recording.decisions.size} decisions")
    finally
      val _ = Await.result(server.close(), 10.seconds)

  private val byDatagrams = MavlinkSettings(udp = Vector(MavlinkPort(Address("127.0.0.1", 0))))

  test("the duel flies by datagrams"):
    flies(byDatagrams)(server => Future.successful(server.peerAddresses.head))

  test("the duel flies by TCP"):
    flies(MavlinkSettings(listen = Some(Address("127.0.0.1", 0))), isTcp = true)(server =>
      Future.successful(server.peerAddresses.head)
    )

  test("the duel flies by datagrams over an emulated link that delays each one separately"):
    val profile =
      LatencyProfile.parse("uniform:10ms..30ms", Left(_)).fold(error => fail(error.message), identity)
    val link = EmulatedLink(LinkProfile.symmetric(profile), seed = 1, Clock.system)
    flies(byDatagrams): server =>
      LinkProxy
        .start(
          Address("127.0.0.1", 0),
          server.peerAddresses.head,
          link,
          UdpTransport(),
          isDatagrams = true
        )
        .map(_.address)(using system.dispatcher)
    assert(link.counts.bytesToServer > 10_000 && link.counts.bytesToClient > 10_000, s"${link.counts}")

  test("a flight without a MAVLink peer reports that"):
    val why = Await.result(unheard, 1.minute)
    assert(why.left.exists(_.contains("expected MAVLink systems 1, 2")), why.toString)
