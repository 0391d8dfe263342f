package skein.buffer

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.airsim.*
import skein.link.*
import skein.policy.Action
import skein.port.CommandPlan
import skein.rpc.RpcClient
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.Waiting
import skein.units.*

/** The external buffer in front of the built-in simulator, over real sockets and by the real clock. */
class BufferLiveSuite extends munit.FunSuite, Waiting:
  private given system: ActorSystem = ActorSystem("BufferLiveSuite")
  import system.dispatcher
  override def afterAll(): Unit = { val _ = Await.result(system.terminate(), 10.seconds) }

  private def right[E, A](answer: Either[E, A]): A = answer.fold(error => fail(error.toString), identity)

  test("a vehicle follows plans through losses, an outage and 400 ms of delay, and hovers after their end"):
    val transport = TcpTransport()
    val free      = Address("127.0.0.1", 0)
    val profile   = right(LatencyProfile.parse("loss:5%/4,outage:500ms/3s,constant:400ms", Left(_)))
    val world     = WorldSettings.of(Vector(VehicleSettings("Drone")))
    val flown     =
      for
        server <- SimulatorServer.start(SimulatorSettings(world, free), transport, Clock.system)
        buffer = SimulatorBuffer.start(server.address, transport, Clock.system)
        link   = EmulatedLink(LinkProfile.symmetric(profile), 1, Clock.system)
        proxy <- LinkProxy.start(free, server.address, link, transport, beside = () => buffer.passing())
        near = AirSimClient(RpcClient(transport, server.address, Clock.system))
        far  = AirSimClient(RpcClient(transport, proxy.address, Clock.system), Span.ofSeconds(10))
        drone   <- Multirotor.named(near, "Drone").map(right)
        _       <- drone.enableApiControl().map(right)
        _       <- drone.hoverAt(VehiclePose(Vector3(0, 0, -20), Quaternion.Identity)).map(right)
        start   <- drone.kinematics().map(right)
        behind  <- Multirotor.named(far, "Drone").map(right)
        answers <- Future.traverse((0 until 30).toVector): number =>
          after((100 * number).millis):
            val moves = Vector.tabulate(16): index =>
              val at = start.validAt + Span.ofMillis(3000 + 100.0 * (number + index))
              (at = at, action = Action.VelocityAt(4, 0, Metres(-20)): Action)
            behind.followPlan(number, CommandPlan(number, moves)).get
        rested <- resting(drone, start.validAt + Span.ofMillis(3000 + 100 * 46 + 1000 + 12_000))
        _      <- far.close()
        _      <- near.close()
        _      <- proxy.close()
        _      <- buffer.close()
        _      <- server.close()
      yield (answers, rested.value, buffer.counts)
    flown.map: (answers, rested, counts) =>
      assert(answers.contains(Right(true)), answers.take(3).toString)
      assert(rested.positionNed.x > 1, s"flew ${rested.positionNed} m")
      assert(rested.velocityNed.norm < 1, s"still ${rested.velocityNed} m/s")
      assert(counts.moves > 1 && counts.plans > 1, counts.toString)
      assertEquals((counts.refusedPlans, counts.failedMoves), (0L, 0L))

  /** The vehicle's state at `at` on the simulator's clock, or later. */
  private def resting(drone: Multirotor, at: Instant): Future[Stamped[Kinematics]] =
    drone.kinematics().map(right).flatMap: seen =>
      if seen.validAt >= at then Future.successful(seen) else after(200.millis)(resting(drone, at))
