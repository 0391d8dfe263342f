package skein.bench

import java.nio.charset.StandardCharsets.US_ASCII
import java.util.Arrays
import java.util.concurrent.ConcurrentLinkedQueue
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.Duration
import scala.concurrent.{Await, Future}
import scala.jdk.CollectionConverters.*
import skein.flight.{FlightAssembler, WarmUp}
import skein.link.*
import skein.loop.LoopKind
import skein.record.MemoryRecorder
import skein.scenario.PaperDuel
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.*

/** How much time does the framework itself add between a reading and the command made from it? The `stream`
  * loop controls twenty vehicles at 10 Hz against the built-in simulator over loopback, simulator included in
  * the process. Measured at the client's sockets: from the last bytes that arrived before a command to the
  * write of the bytes that hold the command; so it includes decoding, joining, deciding and encoding, for all
  * twenty, from the first decision on. As in `./skein fly`, virtual flights and a rehearsal warm up the code
  * before.
  *
  * The witness is the number of commands seen. Arguments: seconds (default 30), pairs of vehicles (default
  * 10), threads that plan continuously meanwhile, as the `plan` loop's do (default 0), virtual flights to
  * warm up by before the rehearsal (default [[skein.flight.WarmUp.Flights]]; 0 for a cold start without one).
  */
object FrameworkLatency:

  def main(args: Array[String]): Unit =
    given system: ActorSystem = ActorSystem("bench")
    import system.dispatcher
    val seconds  = args.headOption.fold(30.0)(_.toDouble)
    val pairs    = args.lift(1).fold(10)(_.toInt)
    val settings = FlySettings(
      List(LoopKind.Stream),
      List(LatencyProfile.none),
      Span.ofSeconds(seconds),
      Span.ofMillis(100),
      1,
      PaperDuel(pairs)
    )
    val warmUp = args.lift(3).fold(WarmUp.Flights)(_.toInt)
    println(WarmUp.fly(settings, warmUp, Clock.system).map(flown => s"warmed up by $flown virtual flights"))
    if warmUp > 0 then
      val rehearsed = Await.result(WarmUp.rehearse(settings, TcpTransport(), Clock.system), Duration.Inf)
      println(rehearsed.map(decisions => s"and by $decisions decisions over loopback"))
    val plan      = settings.plans.head
    val observed  = ObservedTransport(TcpTransport(), Clock.system)
    val assembler = FlightAssembler(observed, Clock.system, settings, simulator = None)
    val recorder  = MemoryRecorder(assembler.heading(plan, "real"))
    val planning  = PlanBench.endlessly(threads = args.lift(2).fold(0)(_.toInt))
    val outcome   =
      assembler.start(
        plan,
        recorder
      ).flatMap(_.fold(reason => Future.failed(RuntimeException(reason)), _.landed))
    println(Await.result(outcome, Duration.Inf).outcome)
    for planned <- planning do
      val candidates = planned.finish().flatMap(_.plans).map(_.candidates).sum
      println(f"planned meanwhile: ${candidates / seconds / 10}%.0f candidates of 2 s per 100 ms")
    val nanos               = observed.latencies.asScala.toVector.sorted
    def quantile(p: Double) = nanos((p * (nanos.size - 1)).toInt) / 1000
    println("vehicles   commands (witness)   p50 us   p99 us  p99.9 us   max us")
    println(
      f"${pairs * 2}%8d ${nanos.size}%20d ${quantile(0.5)}%8d " +
        f"${quantile(0.99)}%8d ${quantile(0.999)}%9d ${quantile(1)}%8d"
    )
    Await.result(system.terminate(), Duration.Inf): Unit

/** A transport that measures the time from the last arrival to each write that contains a move command. */
private final class ObservedTransport(inner: Transport, clock: Clock) extends Transport:
  private val command               = "moveByVelocityZ".getBytes(US_ASCII)
  @volatile private var lastArrival = Instant.Epoch
  val latencies                     = ConcurrentLinkedQueue[Long]()

  def connect(to: Address): Flow[ByteString, ByteString, Future[Done]] =
    val tcp = inner.connect(to)
    Flow[ByteString]
      .map: bytes =>
        // The time is read first, so that it excludes the cost of the measurement itself.
        val latency = clock.now().since(lastArrival).toNanos
        for _ <- 0 until commandsIn(bytes.toArrayUnsafe()) do latencies.add(latency)
        bytes
      .viaMat(tcp)(org.apache.pekko.stream.scaladsl.Keep.right)
      .map: bytes =>
        lastArrival = clock.now()
        bytes

  private def commandsIn(bytes: Array[Byte]): Int =
    var count, from = 0
    while from + command.length <= bytes.length do
      if Arrays.equals(bytes, from, from + command.length, command, 0, command.length) then count += 1
      from += 1
    count

  def listen(at: Address): Source[Incoming, Future[Listening]] = inner.listen(at)
