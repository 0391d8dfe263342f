package skein.rpc

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.collection.mutable
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Random
import skein.link.*
import skein.signal.LatencyProfile
import skein.units.*
import skein.vtime.VirtualTime
import upack.{Int32, Msg}

/** Client and server in virtual time, over links that delay, stall and reset. */
class RpcSimulation extends munit.FunSuite:
  private given ExecutionContext = ExecutionContext.parasitic
  private val address            = Address("simulator", 41451)
  private val calls              = 600

  /** The log of one run: each call's end, in order of ending, and all observed events. */
  private final case class Log(
      ends: Seq[(Int, Either[RpcError, Msg], Long)],
      events: Seq[RpcEvent],
      stats: RpcStats
  )

  /** Runs calls every 10 ms, each echoing its number from a slow server, over a bad VPN. */
  private def fly(seed: Long): Log =
    VirtualTime
      .run(seed): system =>
        given ActorSystem = system
        val clock         = VirtualClock(system)
        val faults        = Faults(
          stallEvery = Some(Span.ofSeconds(2)),
          stallLasts = Span.ofMillis(300),
          resetEvery = Some(Span.ofSeconds(3))
        )
        val plan    = NetworkPlan(LinkProfile.symmetric(LatencyProfile.vpn).copy(faults = faults))
        val network = MemoryNetwork(plan, seed, clock)
        val random  = Random(seed)
        val events  = mutable.Buffer.empty[RpcEvent]
        val ends    = mutable.Buffer.empty[(Int, Either[RpcError, Msg], Long)]
        val client  =
          RpcClient(network.host("controller"), address, clock, RpcSettings(), seed, observer = events += _)
        def options(i: Int) = CallOptions(
          timeout = Span.ofMillis(400),
          idempotent = i % 3 == 0,
          key = Option.when(i % 2 == 0)(i % 7),
          whenFull = if i % 5 == 0 then WhenFull.Wait else WhenFull.Refuse
        )
        for
          server <- RpcServer.bind(network.host("simulator"), address): request =>
            after(random.nextInt(50).millis)(Future.successful(Right(request.params.head)))
          _ <- Source
            .tick(0.millis, 10.millis, ())
            .zipWithIndex
            .take(calls)
            .mapAsyncUnordered(calls): (_, index) =>
              val i = index.toInt
              client.call("echo", Seq(Int32(i)), options(i)).map(result =>
                ends += ((i, result, clock.now().toNanos))
              )
            .runWith(Sink.ignore)
          _ <- client.close()
          _ <- server.close()
        yield Log(ends.toSeq, events.toSeq, client.stats)
      .value

  test("over bad links every call ends once, with its own result or an error, and the counts add up"):
    val logs =
      for seed <- 1 to 5 yield
        val log = fly(seed)
        assertEquals(log.ends.map(_._1).sorted, 0 until calls, s"seed $seed")
        for case (i, Right(result), _) <- log.ends do assertEquals(result, Int32(i), s"seed $seed")
        assertEquals(log.stats.pending, 0L, s"seed $seed")
        assertEquals(log.stats.unexpected, 0L, s"seed $seed")
        assert(log.stats.answered > calls / 3, s"seed $seed: ${log.stats}")
        log.stats
    val cameUp = Seq[RpcStats => Long](_.timedOut, _.late, _.lost, _.sentAgain).map(logs.map(_).sum)
    assert(cameUp.forall(_ > 0), s"timed out, late, lost, sent again: $cameUp")

  test("equal seeds give equal calls, events and times to the nanosecond, different seeds different ones"):
    assertEquals(fly(7), fly(7))
    assertNotEquals(fly(7), fly(8))

  test("all calls are answered, even if more are made than the windows hold"):
    val (answers, stats) = VirtualTime
      .run(seed = 3): system =>
        given ActorSystem = system
        val network       =
          MemoryNetwork(NetworkPlan(LinkProfile.symmetric(LatencyProfile.vpn)), 3, VirtualClock(system))
        val settings = RpcSettings(controlConnections = 1, windowPerConnection = 16)
        val client   = RpcClient(network.host("controller"), address, VirtualClock(system), settings)
        for
          server <- RpcServer.bind(network.host("simulator"), address): request =>
            Future.successful(Right(request.params.head))
          values <- Source(1 to 1_000)
            .mapAsync(250)(i =>
              client.callStampedAs[Int]("echo", Seq(Int32(i)), CallOptions(whenFull = WhenFull.Wait))
            )
            .collect { case Right(answer) => answer.value }
            .runWith(Sink.seq)
          _ <- client.close()
          _ <- server.close()
        yield (values, client.stats)
      .value
    assertEquals(stats.overloaded, 0L, s"$stats")
    assertEquals(answers, 1 to 1_000)
