package skein.observe

import java.util.concurrent.Executors
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.*
import skein.offboard.{MavlinkLink, MavlinkVehicle, OffboardSettings}
import skein.policy.Action
import skein.simulator.{MavlinkPort, MavlinkSettings, SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.units.*

/** A program and a vehicle speak MAVLink by datagrams, over real sockets, through the observer. */
class MavlinkLoopLiveSuite extends munit.FunSuite, Unhurried:
  private given system: ActorSystem = ActorSystem("observed-mavlink")

  override def afterAll(): Unit = Await.result(system.terminate(), 20.seconds): Unit

  private def await[A](future: Future[A]): A = Await.result(future, 60.seconds)
  private val anyPort                        = Address("127.0.0.1", 0)

  test("setpoints are commands, positions are readings, and TIMESYNC bounds their ages"):
    val world = SimulatorSettings(
      WorldSettings(Vector(VehicleSettings("v"))),
      anyPort,
      mavlink = Some(MavlinkSettings(udp = Vector(MavlinkPort(anyPort))))
    )
    val reader = Executors.newSingleThreadExecutor()
    val server = await(SimulatorServer.start(world, TcpTransport(), Clock.system))
    try
      val loop  = MavlinkLoop(isDatagrams = true)
      val proxy = await(
        ObservingProxy.start(
          loop,
          anyPort,
          server.peerAddresses.head,
          EmulatedLink(LinkProfile.none, 1, Clock.system),
          UdpTransport(),
          Clock.system,
          reader,
          reason => fail(reason.getMessage),
          isDatagrams = true
        )
      )
      val link = await(
        MavlinkLink.open(
          UdpTransport().connect(proxy.address),
          Vector(1),
          Clock.system,
          settings = OffboardSettings(exchanges = 20),
          isDatagrams = true
        )
      ).fold(error => fail(error.message), identity)
      val vehicle = MavlinkVehicle(link, 1)
      for _ <- 1 to 5 do assert(await(vehicle.read()).isRight)
      assert(await(vehicle.arm()).isRight)
      assert(await(vehicle.takeoff()).isRight)
      assert(await(vehicle.act(Action.Velocity(Vector3(1, 0, 0)), Span.ofMillis(500))).isRight)
      await(link.close()): Unit
      await(proxy.close()): Unit
      val observed = proxy.observed
      val seen     = observed.vehicles.find(_.name == "system 1").get
      assert(seen.commands > 0, observed)
      // Bounded by the slowest exchange: no bound at all would be that of a clock since boot.
      assert(seen.boundMs.exists(_ < 1000), seen.boundMs)
      assertEquals(observed.byOtherClock, Vector.empty)
      assert(
        observed.topics.exists(topic => topic.kind == TopicKind.Readings && topic.messages > 5),
        observed.topics
      )
    finally
      reader.shutdown()
      await(server.close()): Unit
