package skein.simulator

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.ExecutionContext
import scala.concurrent.duration.*
import skein.airsim.{AirSimClient, Multirotor, VehiclePose, VehicleSettings, WorldSettings}
import skein.link.*
import skein.rpc.RpcClient
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime

/** Simulator, client and the paper's busy link between them, in virtual time: a minute of two vehicles
  * steered at 10 Hz.
  */
class FlightOverVpnSimulation extends munit.FunSuite, Unhurried:

  private val seed     = 7L
  private val vehicles = Vector(VehicleSettings("Evader"), VehicleSettings("Pursuer", Vector3(-21, 0, 0)))
  private val ticks    = 600

  private def fly(seed: Long): Seq[Stamped[Kinematics]] =
    VirtualTime
      .run(seed): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = VirtualClock(system)
        val network  = MemoryNetwork(NetworkPlan(LinkProfile.symmetric(LatencyProfile.vpn)), seed, clock)
        val settings =
          SimulatorSettings(
            WorldSettings.of(vehicles),
            Address("simulator", 41451)
          )
        for
          server <- SimulatorServer.start(settings, network.host("simulator"), clock)
          client = AirSimClient(RpcClient(network.host("controller"), server.address, clock))
          multirotors <- climb(client)
          flown       <- Source
            .tick(0.millis, 100.millis, ())
            .take(ticks)
            .zipWithIndex
            .mapAsync(1): (_, tick) =>
              multirotors.foreach: multirotor =>
                val heading = tick * 0.02
                multirotor.moveByVelocityZ(
                  Vector3(5 * math.cos(heading), 5 * math.sin(heading), 0),
                  Metres(-20),
                  Span.ofSeconds(10)
                )
              multirotors.head.kinematics()
            .map(_.fold(error => throw AssertionError(error.message), identity))
            .runWith(Sink.seq)
          _ <- client.close()
          _ <- server.close()
        yield flown
      .value

  private def climb(client: AirSimClient)(using ExecutionContext) =
    scala.concurrent.Future.traverse(vehicles): vehicle =>
      for
        found <- Multirotor.named(client, vehicle.name)
        multirotor = found.fold(error => throw AssertionError(error.message), identity)
        _ <- multirotor.enableApiControl()
        _ <- multirotor.hoverAt(VehiclePose(vehicle.startNed + Vector3(0, 0, -20), Quaternion.Identity))
      yield multirotor

  test(
    "a flight over the busy link is smooth, its readings are as old as the link's delay, and it repeats " +
      "exactly"
  ):
    clue(seed)
    val flown = fly(seed)
    assertEquals(flown.size, ticks)
    assertEquals(fly(seed), flown)
    assert(fly(seed + 1) != flown, "another seed, another flight")

    val trips = flown.map(_.roundTrip.toMillis)
    assertEqualsDouble(trips.sum / trips.size, 102.8, 5)
    for reading <- flown do
      assert(reading.sentAt <= reading.validAt && reading.validAt <= reading.receivedAt, s"$reading")

    val last = flown.drop(ticks / 2).map(_.value)
    last.foreach: state =>
      assert(state.velocityNed.norm > 3 && state.velocityNed.norm < 5, s"${state.velocityNed}")
      assertEqualsDouble(state.positionNed.z, -20, 0.5)
