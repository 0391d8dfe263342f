package skein.simulator

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.*
import skein.link.*
import skein.policy.{Action, Yaw}
import skein.port.VehicleError
import skein.rpc.RpcClient
import skein.signal.LatencyProfile
import skein.units.*
import skein.vtime.VirtualTime

/** A car as a loop's vehicle port, over a link with 40 ms round trips. */
class AirSimCarSuite extends munit.FunSuite:
  private val address = Address("simulator", 41451)

  private final class Drive(val car: AirSimCar, clock: Clock, val close: () => Future[Any])(using
      system: ActorSystem
  ):
    given ExecutionContext = system.dispatcher

    def nowMs: Long = clock.now().toNanos / 1_000_000

    def pass(ms: Double): Future[Unit] = after(Span.ofMillis(ms).toDuration)(Future.unit)

  private def driven[A](drive: Drive => Future[A]): A = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock   = Clock.ofNanos(VirtualTime.clock(system))
      val link    = LinkProfile.symmetric(LatencyProfile.parse("constant:40ms", Left(_)).toOption.get)
      val network = MemoryNetwork(NetworkPlan(links = Map(("controller", "simulator") -> link)), 1, clock)
      val cars    = Vector(VehicleSettings("Car", vehicleType = "PhysXCar"))
      val world   = WorldSettings.of(cars)
      val client  = AirSimClient(RpcClient(network.host("controller"), address, clock), Span.ofMillis(500))
      for
        server <- SimulatorServer.start(SimulatorSettings(world, address), network.host("simulator"), clock)
        car    <- Car.named(client, "Car").map(_.fold(error => fail(error.message), identity))
        _      <- car.enableApiControl()
        result <- drive(Drive(AirSimCar(car), clock, () => server.close()))
        _      <- client.close()
        _      <- server.close()
      yield result
    .value

  private val ahead = Action.VelocityAt(6, 0, Metres(0))

  test("an action ends when the next one arrives, and is answered a round trip after that one was sent"):
    val ended = driven: drive =>
      import drive.given
      val first = drive.car.act(ahead, Span.ofSeconds(10))
      for
        _ <- drive.pass(500)
        sentAt = drive.nowMs
        _      = drive.car.act(Action.Velocity(Vector3(0, 6, 0)), Span.ofSeconds(10))
        answer <- first
      yield (answer, drive.nowMs - sentAt)
    assertEquals(ended, (Right(false), 40L))

  test("a car follows a repeated velocity command, and heads in the direction in which it drives"):
    val seen = driven: drive =>
      import drive.given
      def go(times: Int): Future[Unit] =
        if times == 0 then Future.unit
        else
          for
            _ <- drive.car.read()
            _ = drive.car.act(Action.VelocityAt(3, 5, Metres(0)), Span.ofSeconds(10))
            _ <- drive.pass(100)
            _ <- go(times - 1)
          yield ()
      go(80).flatMap(_ => drive.car.read()).map(_.toOption.get.value)
    assert((seen.velocityNed - Vector3(3, 5, 0)).norm < 0.1, seen)
    assertEqualsDouble(seen.orientation.yawRad, math.atan2(5, 3), 0.02)

  test("a car reaches a position, and stops when the action's time has elapsed"):
    val (answer, rolling, stood) = driven: drive =>
      import drive.given
      val action = drive.car.act(ahead, Span.ofSeconds(2))
      for
        _       <- drive.pass(1900)
        rolling <- drive.car.read()
        answer  <- action
        _       <- drive.pass(2000)
        stood   <- drive.car.read()
      yield (answer, rolling.toOption.get.value, stood.toOption.get.value)
    assertEquals(answer, Right(true))
    assert(rolling.velocityNed.x > 5, rolling)
    assertEquals(stood.velocityNed, Vector3.Zero)

  test("hovering and landing brake and end the current action, and actions impossible for a car are refused"):
    val (moving, hovering, landing, turning, tilting) = driven: drive =>
      import drive.given
      val moving = drive.car.act(ahead, Span.ofSeconds(10))
      for
        _        <- drive.pass(2000)
        hovering <- drive.car.hover()
        _        <- drive.pass(2000)
        stood    <- drive.car.read()
        landing  <- drive.car.act(Action.Land, Span.ofSeconds(10))
        turning  <- drive.car.act(Action.Turn(Yaw.Towards(Radians(1))), Span.ofSeconds(1))
        tilting  <- drive.car.act(Action.Attitude(Radians(0), Radians(0), Radians(0), 0.5), Span.ofSeconds(1))
        ended    <- moving
      yield
        assertEquals(stood.toOption.get.value.velocityNed, Vector3.Zero)
        (ended, hovering, landing, turning, tilting)
    assertEquals((moving, hovering, landing), (Right(false), Right(true), Right(true)))
    for refused <- Seq(turning, tilting) do
      assert(refused.left.exists(_.isInstanceOf[VehicleError.Unsupported]), refused)

  test("if the simulator is gone, an action and the one before it end with the error"):
    val (first, second) = driven: drive =>
      import drive.given
      for
        _ <- drive.car.read()
        first = drive.car.act(ahead, Span.ofSeconds(10))
        _ <- drive.pass(200)
        _ <- drive.close()
        _ <- drive.pass(200)
        second = drive.car.act(ahead, Span.ofSeconds(10))
        answers <- first.zip(second)
      yield answers
    for answer <- Seq(first, second) do assert(answer.isLeft, answer)
