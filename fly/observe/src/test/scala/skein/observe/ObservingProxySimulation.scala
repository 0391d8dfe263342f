package skein.observe

import java.util.concurrent.ConcurrentLinkedQueue
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Flow, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.{AirSimClient, Multirotor, VehiclePose, VehicleSettings, WorldSettings}
import skein.link.*
import skein.rpc.RpcClient
import skein.signal.LatencyProfile
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime
import upack.{Arr, Int32, Str}

/** A program flies the built-in simulator through the observer, in virtual time; the data ages that the
  * observer reports are compared with the program's own records.
  */
class ObservingProxySimulation extends munit.FunSuite, Unhurried:
  private val vehicles = Vector(VehicleSettings("Evader"), VehicleSettings("Pursuer", Vector3(-21, 0, 0)))

  /** The result of an observed flight.
    *
    * @param ages ages of the evader's data at each of its commands, ms, on the simulator's own clock
    */
  private final case class Flown(observed: Observed, ages: Seq[Double])

  private def fly(profile: LatencyProfile, seed: Long): Flown =
    VirtualTime
      .run(seed): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = VirtualClock(system)
        val network            = MemoryNetwork(NetworkPlan(), seed, clock)
        val settings           = SimulatorSettings(
          WorldSettings.of(vehicles),
          Address("simulator", 41451)
        )
        val here = network.host("controller")
        for
          server <- SimulatorServer.start(settings, network.host("simulator"), clock)
          link = EmulatedLink(LinkProfile.symmetric(profile), seed, clock)
          proxy <- ObservingProxy.start(
            AirSimAnalysis(),
            Address("controller", 41452),
            server.address,
            link,
            here,
            clock,
            system.dispatcher
          )
          client = AirSimClient(RpcClient(here, proxy.address, clock))
          direct = AirSimClient(RpcClient(here, server.address, clock))
          beside <- named(direct, "Evader")
          evader <- named(client, "Evader")
          _      <- evader.enableApiControl()
          _      <- evader.hoverAt(VehiclePose(Vector3(0, 0, -20), Quaternion.Identity))
          // Nothing delays the answer: its time stamp is the present time.
          stamped <- beside.kinematics().map(_.fold(error => throw AssertionError(error.message), identity))
          offset = stamped.receivedAt.since(stamped.validAt)
          ages <- Source
            .tick(0.millis, 100.millis, ())
            .take(300)
            .mapAsync(1): _ =>
              evader.kinematics().map: read =>
                val reading = read.fold(error => throw AssertionError(error.message), identity)
                evader.moveByVelocityZ(Vector3(5, 0, 0), Metres(-20), Span.ofSeconds(10)): Unit
                clock.now().since(reading.validAt + offset).toMillis
            .runWith(Sink.seq)
          _ <- client.close()
          _ <- direct.close()
          _ <- proxy.close()
          _ <- server.close()
        yield Flown(proxy.observed, ages)
      .value

  private def named(client: AirSimClient, name: String)(using ExecutionContext): Future[Multirotor] =
    Multirotor.named(client, name).map(_.fold(error => throw AssertionError(error.message), identity))

  test("a browser's connection is closed and does not reach the simulator, which still answers others"):
    val (told, answered) = VirtualTime
      .run(7): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = VirtualClock(system)
        val network            = MemoryNetwork(NetworkPlan(), 7, clock)
        val settings           =
          SimulatorSettings(WorldSettings.of(vehicles), Address("simulator", 41451))
        val (here, told) = (network.host("controller"), ConcurrentLinkedQueue[String]())
        for
          server <- SimulatorServer.start(settings, network.host("simulator"), clock)
          proxy  <- ObservingProxy.start(
            AirSimAnalysis(),
            Address("controller", 41452),
            server.address,
            EmulatedLink(LinkProfile.none, 7, clock),
            here,
            clock,
            system.dispatcher,
            reason => told.add(reason.getMessage): Unit
          )
          page <- Source
            .single(ByteString("POST / HTTP/1.1\r\n\r\n"))
            .concat(Source.maybe)
            .via(here.connect(proxy.address))
            .runWith(Sink.seq)
            .transform(answer => scala.util.Success(answer.getOrElse(Nil)))
          client = AirSimClient(RpcClient(here, proxy.address, clock))
          answered <- client.ping()
          _        <- client.close()
          _        <- proxy.close()
          stats = server.stats
          _ <- server.close()
        yield (told.toArray.toSeq, (page.isEmpty, answered.isRight, stats.malformed))
      .value
    assertEquals(answered, (true, true, 0L))
    assert(clue(told).exists(_.toString.contains("got an HTTP request (POST)")))

  test("what a program sent last arrives, and its move that still runs is seen, if it is closed thereafter"):
    val move = ByteString(upack.write(Arr(Int32(0), Int32(1), Str("hover"), Arr(Str("Evader")))))
    val (arrived, observed) = VirtualTime
      .run(7): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = VirtualClock(system)
        val network            = MemoryNetwork(NetworkPlan(), 7, clock)
        val here               = network.host("controller")
        var arrived            = 0
        val swallow            = Flow[ByteString].mapConcat: bytes =>
          arrived += bytes.size
          Vector.empty[ByteString]
        for
          _ <- network.host("simulator").listen(Address("simulator", 41451))
            .to(Sink.foreach(_.flow.join(swallow).run(): Unit)).run()
          proxy <- ObservingProxy.start(
            AirSimAnalysis(),
            Address("controller", 41452),
            Address("simulator", 41451),
            EmulatedLink(LinkProfile.symmetric(LatencyProfile.vpn), 7, clock),
            here,
            clock,
            system.dispatcher
          )
          _ = Source.single(move).via(here.connect(proxy.address)).runWith(Sink.ignore)
          _ <- after(1.milli, system.scheduler)(Future.unit)
          _ <- proxy.ended()
          _ <- proxy.close()
        yield (arrived, proxy.observed)
      .value
    assertEquals(arrived, move.size)
    assertEquals(observed.vehicles.map(_.leftRunning), Vector(1L))

  for profile <- Seq(LatencyProfile.direct, LatencyProfile.vpn) do
    test(s"over ${profile.name} the ages that the observer reports are the program's own, within its bounds"):
      val flown  = fly(profile, seed = 5)
      val evader = flown.observed.vehicles.find(_.name == "Evader").get
      val mean   = flown.ages.sum / flown.ages.size
      assert(evader.commands >= 300, evader.commands)
      val told = evader.ownAgeMs.get.mean
      assert(math.abs(told - mean) <= evader.boundMs.get + 3, s"told $told ± ${evader.boundMs}, is $mean")
      assertEquals(flown.observed.lost, Vector.empty)
      assertEquals(flown.observed.notKept, 0L)
