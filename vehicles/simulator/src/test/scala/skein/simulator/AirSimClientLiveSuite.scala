package skein.simulator

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.airsim.{AirSimClient, Lookahead, Multirotor, VehiclePose, VehicleSettings, WorldSettings}
import skein.link.{Address, TcpTransport, TransportError}
import skein.policy.Yaw
import skein.rpc.{RpcClient, RpcError, RpcSettings}
import skein.testing.Unhurried
import skein.units.*

/** The typed client against the built-in simulator over real sockets, with a clock ten times as fast as the
  * machine's clock.
  */
class AirSimClientLiveSuite extends munit.FunSuite, Unhurried:
  private given system: ActorSystem = ActorSystem("airsim-client")
  import system.dispatcher

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private val start    = Vector3(-21, 3, 0)
  private val vehicles = Vector(VehicleSettings("Evader"), VehicleSettings("Pursuer", start))
  private val settings = SimulatorSettings(
    WorldSettings.of(vehicles),
    Address("127.0.0.1", 0),
    speed = 10
  )

  private val flown = FunFixture[(SimulatorServer, AirSimClient)](
    setup = _ =>
      val server = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
      // One connection, so that calls arrive in the order in which they are made.
      val inOrder = RpcSettings(controlConnections = 1)
      (server, AirSimClient(RpcClient(TcpTransport(), server.address, Clock.system, inOrder)))
    ,
    teardown = (server, client) =>
      Await.result(client.close().flatMap(_ => server.close()), 10.seconds): Unit
  )

  private def done[E, A](call: Future[Either[E, A]]): A =
    Await.result(call, 20.seconds).fold(error => throw AssertionError(error), identity)

  private def airborne(client: AirSimClient, name: String, positionNed: Vector3): Multirotor =
    val vehicle = done(Multirotor.named(client, name))
    done(vehicle.enableApiControl())
    assert(done(vehicle.arm()))
    done(vehicle.hoverAt(VehiclePose(positionNed, Quaternion.Identity)))
    vehicle

  flown.test("versions, vehicles and settings are read"): (_, client) =>
    assert(done(client.ping()))
    assertEquals((done(client.serverVersion()), done(client.minRequiredClientVersion())), (4, 1))
    assertEquals(done(client.vehicles()), Seq("Evader", "Pursuer"))
    assertEquals(done(client.settings()).vehicles, vehicles)

  flown.test("positions are in the world's frame, whatever the vehicle's own origin"): (_, client) =>
    val pursuer = done(Multirotor.named(client, "Pursuer"))
    assertEquals(pursuer.originNed, start)
    assertEquals(done(pursuer.kinematics()).value.positionNed, start)
    airborne(client, "Pursuer", Vector3(-10, 0, -20))
    val there = done(pursuer.kinematics()).value.positionNed
    assert((there - Vector3(-10, 0, -20)).norm < 0.01, there)
    assert((done(pursuer.groundTruth()).positionNed - there).norm < 0.01)
    assert((done(pursuer.pose()).positionNed - there).norm < 0.01)

  flown.test("a reading carries the times of sampling, request and answer"): (_, client) =>
    val evader = done(Multirotor.named(client, "Evader"))
    val before = Clock.system.now()
    val first  = done(evader.kinematics())
    val second = done(evader.kinematics())
    val after  = Clock.system.now()
    val times  = Seq(before, first.sentAt, first.receivedAt, second.sentAt, second.receivedAt, after)
    assertEquals(times.sorted, times)
    assert(second.validAt > first.validAt)

  flown.test("a step of the paused simulator is exact"): (_, client) =>
    val evader = airborne(client, "Evader", Vector3(0, 0, -20))
    done(client.pause())
    assert(done(client.isPaused()))
    val move   = evader.moveByVelocityZ(Vector3(5, 0, 0), Metres(-20), Span.ofSeconds(1))
    val before = done(evader.kinematics())
    done(client.continueFor(Span.ofMillis(100)))
    val after = done(evader.kinematics())
    assertEquals(after.validAt.since(before.validAt), Span.ofMillis(100))
    assert(after.value.velocityNed.x > before.value.velocityNed.x)
    done(client.continueFor(Span.ofSeconds(1)))
    assert(done(move), "flown to its end")
    done(client.resume())

  flown.test("a newer move ends the older with false"): (_, client) =>
    val evader = airborne(client, "Evader", Vector3(0, 0, -20))
    val older  = evader.moveByVelocity(Vector3(2, 0, 0), Span.ofSeconds(60))
    val newer  = evader.moveByVelocity(Vector3(0, 2, 0), Span.ofSeconds(1), Yaw.Forward)
    assertEquals((done(older), done(newer)), (false, true))

  flown.test("the simulator accepts every move of the client"): (_, client) =>
    val evader = airborne(client, "Evader", Vector3(0, 0, -10))
    val second = Span.ofSeconds(1)
    assert(done(evader.moveToPosition(Vector3(5, 0, -10), MetresPerSecond(3))))
    assert(done(evader.moveOnPath(
      Seq(Vector3(5, 5, -10), Vector3(0, 5, -10)),
      MetresPerSecond(3),
      yaw = Yaw.Forward
    )))
    assert(done(evader.moveToZ(Metres(-6), MetresPerSecond(4), lookahead = Lookahead.Fixed(Metres(1)))))
    assert(done(evader.moveByVelocityBodyFrame(Vector3(1, 0, 0), second)))
    assert(done(evader.moveByVelocityZBodyFrame(Vector3(1, 0, 0), Metres(-8), second)))
    assert(done(evader.moveByRollPitchYawZ(Radians(0), Radians(0), Radians(0), Metres(-8), second)))
    val briefly = Span.ofSeconds(0.1)
    val level   = Radians(0)
    assert(done(evader.moveByRollPitchYawThrottle(level, level, level, 0.6, briefly)))
    assert(done(evader.moveByRollPitchYawRateZ(level, level, 0.1, Metres(-8), briefly)))
    assert(done(evader.moveByRollPitchYawRateThrottle(level, level, 0.1, 0.6, briefly)))
    assert(done(evader.moveByAngleRatesZ(0, 0, 0.1, Metres(-8), briefly)))
    assert(done(evader.moveByAngleRatesThrottle(0, 0, 0.1, 0.6, briefly)))
    assert(done(evader.moveByMotorPwms(0.6, 0.6, 0.6, 0.6, briefly)))
    val home = done(evader.home())
    assert(done(evader.moveToGps(home.copy(altitude = Metres(home.altitude.value + 25)), MetresPerSecond(5))))
    assert(done(evader.moveToZ(Metres(-6), MetresPerSecond(4))))
    assert(done(evader.rotateToYaw(Radians(1.0))))
    assert(done(evader.rotateByYawRate(0.5, second)))
    assert(!done(evader.hover()))
    assert(done(evader.land()))
    assert(done(evader.collision()).exists(_.objectName == "Ground"))
    assert(done(evader.disarm()))
    assert(!done(evader.takeoff(Span.ofSeconds(0.1))))
    done(client.reset())
    assert(!done(evader.isApiControlEnabled()))

  flown.test("sensors show a hovering vehicle"): (_, client) =>
    val evader = airborne(client, "Evader", Vector3(0, 0, -20))
    // The GPS is silent for its first second.
    done(client.pause())
    done(client.continueFor(Span.ofSeconds(1)))
    assertEqualsDouble(done(evader.imu()).value.specificForceFrd.z, -9.80665, 0.01)
    assert(done(evader.gps()).value.valid)
    assertEqualsDouble(done(evader.gps()).value.location.altitude.value, 142, 0.01)
    assertEqualsDouble(done(evader.barometer()).value.altitude.value, 142, 0.5)
    assert(done(evader.magnetometer()).value.x > 0.1)
    // Reported as at sea level: the weight divided by the relative density of the air here.
    assertEqualsDouble(done(evader.rotors()).value.map(_.thrustN).sum, 9.942, 0.01)
    assertEqualsDouble(done(evader.home()).latitudeDeg, 47.641468, 1e-9)
    assert(done(evader.status()).value.flying)

  flown.test("a wrong vehicle name is reported with the existing names"): (_, client) =>
    assertEquals(
      Await.result(Multirotor.named(client, "Nope"), 10.seconds).left.map(_.message).left.getOrElse(""),
      "the simulator has no vehicle 'Nope'; it has 'Evader', 'Pursuer'"
    )

  flown.test("an error contains the simulator's own text"): (_, client) =>
    val ghost = Multirotor(client, "Nope")
    Await.result(ghost.kinematics(), 10.seconds) match
      case Left(RpcError.Refused("getMultirotorState", text)) =>
        assert(text.contains("Vehicle API for 'Nope'"), text)
      case other => fail(s"$other")

  flown.test("a port in use is reported as such"): (server, _) =>
    val again = SimulatorServer.start(settings.copy(address = server.address), TcpTransport(), Clock.system)
    assertEquals(Await.result(again.failed, 10.seconds), TransportError.PortTaken(server.address))
