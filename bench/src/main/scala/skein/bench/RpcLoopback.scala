package skein.bench

import com.sun.management.OperatingSystemMXBean
import java.lang.management.ManagementFactory
import java.util.concurrent.atomic.{AtomicInteger, LongAdder}
import java.util.concurrent.locks.LockSupport
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.Duration
import scala.concurrent.{Await, ExecutionContext, Future, Promise}
import skein.link.{Address, TcpTransport}
import skein.rpc.*
import skein.units.Clock
import upack.{Binary, Float32, Msg, Obj, Str}

/** How fast is the RPC over loopback, client and server in one JVM? A kinematics request carries a vehicle's
  * name and its reply 13 + 6 floats in maps, encoded at the server and decoded at the client to `upack`
  * values. The witness of each row is the number of replies with correct content; `cpu` is how many cores the
  * whole process used.
  *
  * Arguments: seconds per row (default 5), seconds of the steady rate (default 10).
  */
object RpcLoopback:

  def main(args: Array[String]): Unit =
    val seconds       = args.headOption.fold(5.0)(_.toDouble)
    val steadySeconds = args.lift(1).fold(10.0)(_.toDouble)
    given ActorSystem = ActorSystem("bench")
    val bench         = RpcLoopback()
    for warmUp <- Seq(true, false) do
      val span = if warmUp then math.min(seconds, 3.0) else seconds
      if !warmUp then
        println(
          "row                                     witness     per second   p50 us   p99 us p99.9 us   max us"
        )
      bench.closedLoop("sequential, 1 connection", 1, 1, span, warmUp)
      bench.closedLoop("5 outstanding, 1 connection", 1, 5, span, warmUp)
      bench.closedLoop("50 outstanding, 1 connection", 1, 50, span, warmUp)
      bench.closedLoop("500 outstanding, 1 connection", 1, 500, span, warmUp)
      bench.closedLoop("4 outstanding, 4 connections", 4, 4, span, warmUp)
      bench.closedLoop("200 outstanding, 4 connections", 4, 200, span, warmUp)
      bench.openLoop("10,000/s, 4 connections", 4, 10_000, if warmUp then 2 else steadySeconds, warmUp)
      bench.images("8 MiB replies, one at a time", 1, span, warmUp)
      bench.images("8 MiB replies, 4 outstanding", 4, span, warmUp)
    bench.stop()

/** Measures a client and a server of MessagePack-RPC over loopback. */
final class RpcLoopback(using system: ActorSystem):
  private given ExecutionContext = ExecutionContext.parasitic

  private val process    = ManagementFactory.getPlatformMXBean(classOf[OperatingSystemMXBean])
  private val transport  = TcpTransport()
  private val image      = Binary(Array.tabulate(8 << 20)(i => (i * 31 >> 3).toByte))
  private val kinematics =
    def vector(x: Float) =
      Obj(Str("x_val") -> Float32(x), Str("y_val") -> Float32(1), Str("z_val") -> Float32(-20))
    Obj(
      Str("position")    -> vector(1),
      Str("orientation") -> Obj(
        Str("w_val") -> Float32(1),
        Str("x_val") -> Float32(0),
        Str("y_val") -> Float32(0),
        Str("z_val") -> Float32(0)
      ),
      Str("linear_velocity")      -> vector(2),
      Str("angular_velocity")     -> vector(3),
      Str("linear_acceleration")  -> vector(4),
      Str("angular_acceleration") -> vector(5)
    )

  private val server = Await.result(
    RpcServer.bind(transport, Address("127.0.0.1", 0), ServerLimits(inFlightPerConnection = 1024)): request =>
      Future.successful(Right(if request.method == "image" then image else kinematics)),
    Duration.Inf
  )

  /** Keeps `outstanding` calls in progress for `seconds`; latency from call to answer. */
  def closedLoop(name: String, connections: Int, outstanding: Int, seconds: Double, quiet: Boolean): Unit =
    val client    = clientWith(connections, outstanding)
    val latencies = Latencies()
    val good      = LongAdder()
    val cpu       = cpuNanos()
    val started   = System.nanoTime()
    val until     = started + (seconds * 1e9).toLong
    val running   = AtomicInteger(outstanding)
    val finished  = Promise[Unit]()

    def next(): Unit =
      val at = System.nanoTime()
      if at >= until then
        if running.decrementAndGet() == 0 then finished.success(())
      else
        client
          .call("simGetGroundTruthKinematics", Seq(Str("Drone1")))
          .foreach: result =>
            latencies.add(System.nanoTime() - at)
            if result.exists(isKinematics) then good.increment()
            next()

    for _ <- 1 to outstanding do next()
    finish(finished.future)
    report(name, good.sum, started, cpu, latencies, quiet)
    finish(client.close())

  /** Calls at a fixed rate, independent of the answers; latency from the intended tick. */
  def openLoop(name: String, connections: Int, perSecond: Int, seconds: Double, quiet: Boolean): Unit =
    val client    = clientWith(connections, 4096)
    val latencies = Latencies()
    val good      = LongAdder()
    val total     = (perSecond * seconds).toInt
    val ended     = AtomicInteger()
    val finished  = Promise[Unit]()
    val cpu       = cpuNanos()
    val started   = System.nanoTime() + 10_000_000
    var sent      = 0
    while sent < total do
      val tick = started + sent * 1_000_000_000L / perSecond
      val wait = tick - System.nanoTime()
      if wait > 0 then LockSupport.parkNanos(wait)
      else
        sent += 1
        client
          .call("simGetGroundTruthKinematics", Seq(Str("Drone1")))
          .foreach: result =>
            latencies.add(System.nanoTime() - tick)
            if result.exists(isKinematics) then good.increment()
            if ended.incrementAndGet() == total then finished.success(())
    finish(finished.future)
    report(name, good.sum, started, cpu, latencies, quiet)
    finish(client.close())

  def images(name: String, outstanding: Int, seconds: Double, quiet: Boolean): Unit =
    val client   = clientWith(1, outstanding)
    val started  = System.nanoTime()
    val until    = started + (seconds * 1e9).toLong
    val good     = LongAdder()
    val running  = AtomicInteger(outstanding)
    val finished = Promise[Unit]()
    val options  = CallOptions(channel = Channel.Bulk)

    def next(): Unit =
      if System.nanoTime() >= until then
        if running.decrementAndGet() == 0 then finished.success(())
      else
        client
          .call("image", Seq.empty, options)
          .foreach:
            case Right(Binary(bytes)) if isImage(bytes) =>
              good.increment()
              next()
            case _ => next()

    for _ <- 1 to outstanding do next()
    finish(finished.future)
    val elapsed = (System.nanoTime() - started) * 1e-9
    if !quiet then
      println(
        f"$name%-38s ${good.sum}%8d ${good.sum * image.value.length / elapsed * 1e-9}%9.3f GB/s of payload"
      )
    finish(client.close())

  def stop(): Unit =
    finish(server.close())
    finish(system.terminate())

  private def finish(future: Future[Any]): Unit =
    val _ = Await.result(future, Duration.Inf)

  private def clientWith(connections: Int, window: Int) = RpcClient(
    transport,
    server.address,
    Clock.system,
    RpcSettings(
      controlConnections = connections,
      windowPerConnection = math.max(window, 1024),
      windowInAll = 4096,
      queue = 4096
    )
  )

  private def isKinematics(reply: Msg): Boolean = reply match
    case Obj(entries) => entries.size == 6
    case _            => false

  private def isImage(bytes: Array[Byte]): Boolean =
    bytes.length == image.value.length && bytes(
      4_000_003
    ) == image.value(4_000_003) && bytes.last == image.value.last

  private def report(
      name: String,
      good: Long,
      started: Long,
      cpu: Long,
      latencies: Latencies,
      quiet: Boolean
  ): Unit =
    if !quiet then
      val seconds = (System.nanoTime() - started) * 1e-9
      val cores   = (cpuNanos() - cpu) * 1e-9 / seconds
      val us      = Seq(0.5, 0.99, 0.999, 1.0).map(p => f"${latencies.quantile(p) * 1e-3}%8.0f").mkString(" ")
      println(f"$name%-38s $good%8d ${good / seconds}%14.0f $us ${cores}%6.2f")

  private def cpuNanos(): Long = process.getProcessCpuTime
