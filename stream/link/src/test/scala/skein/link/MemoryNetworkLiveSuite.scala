package skein.link

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future}
import skein.signal.*
import skein.testing.Unhurried
import skein.units.{Clock, Span}

/** Uses the real clock and many threads. */
class MemoryNetworkLiveSuite extends munit.FunSuite, Unhurried:
  private given system: ActorSystem = ActorSystem("memory-network", PreciseScheduler.config)
  private given ExecutionContext    = system.dispatcher

  override def afterAll(): Unit = system.terminate(): Unit

  test("fifty simultaneous connections carry every byte"):
    val latency =
      LatencyProfile.Steady("uniform", LatencyDistribution.Uniform(Span.ofMillis(1), Span.ofMillis(20)))
    val network   = MemoryNetwork(NetworkPlan(LinkProfile.symmetric(latency)), seed = 1, Clock.system)
    val simulator = Address("simulator", 41451)
    val client    = network.host("controller")
    def exchange(connection: Int): Future[Boolean] =
      val sent = (1 to 200).map(i => ByteString(s"$connection:$i;"))
      Source(
        sent
      ).via(client.connect(simulator)).runFold(ByteString.empty)(_ ++ _).map(_ == sent.reduce(_ ++ _))
    for
      _ <- network
        .host(simulator.host)
        .listen(simulator)
        .to(Sink.foreach(_.flow.join(Flow[ByteString]).run(): Unit))
        .run()
      same <- Future.traverse((1 to 50).toVector)(exchange)
    yield
      assertEquals(same.count(identity), 50)
      assertEquals(network.counts("controller", "simulator").connections, 50L)
