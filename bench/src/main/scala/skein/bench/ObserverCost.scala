package skein.bench

import com.sun.management.OperatingSystemMXBean
import java.io.{DataInputStream, EOFException, IOException, OutputStream}
import java.lang.management.ManagementFactory
import java.net.{InetAddress, ServerSocket, Socket}
import java.nio.ByteBuffer
import java.util.concurrent.Executors
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import scala.util.Using
import skein.link.*
import skein.measure.Distribution
import skein.observe.{AirSimAnalysis, ObservingProxy}
import skein.units.*
import skein.units.Decimals.fixed

/** The cost of standing between a program and its simulator: `bench/runMain skein.bench.ObserverCost`.
  *
  * The server answers each call with a number of bytes, as AirSim answers with a state or an image. Calls go
  * directly and through [[ObservingProxy]] in turns, by blocking sockets; each row's witness is the number of
  * bytes received, and the number that the observer counted.
  */
object ObserverCost:
  private given system: ActorSystem = ActorSystem("observer-cost", ObservingProxy.Settings)

  def main(arguments: Array[String]): Unit =
    try
      latency(calls = 20_000, warmUp = 20_000)
      throughput(megabytes = 64, calls = 100)
    finally Await.result(system.terminate(), 20.seconds): Unit

  private def latency(calls: Int, warmUp: Int): Unit = between(500): (direct, through) =>
    for _ <- 0 until warmUp do
      direct.call(): Unit
      through.call(): Unit
    val (one, two) = (0 until calls).map(_ => (direct.timed(), through.timed())).unzip
    for (name, times) <- Seq("directly" -> one, "observed" -> two) do
      val us = Distribution.of(times.map(_ * 1e-3)).get
      println(
        s"$name: ${us.count} calls, median ${us.median.fixed(1)} µs, p99 ${us.p99.fixed(1)} µs, " +
          s"most ${us.most.fixed(0)} µs"
      )
    def median(times: Seq[Long]) = Distribution.of(times.map(_ * 1e-6)).get.median
    println(s"the observer adds ${(median(two) - median(one)).fixed(3)} ms at the median")

  private def throughput(megabytes: Int, calls: Int): Unit = between(megabytes << 20): (direct, through) =>
    val clients = Seq("directly" -> direct, "observed" -> through)
    for (_, client) <- clients; _ <- 0 until 5 do client.call(): Unit
    // In turns, so that both meet the machine's other work.
    val taken =
      for _ <- 0 until calls; (name, client) <- clients yield
        val (startedAt, workedBefore) = (System.nanoTime(), processorNs)
        val bytes                     = client.call()
        (name, bytes, System.nanoTime() - startedAt, processorNs - workedBefore)
    for (name, all) <- taken.groupBy(_._1).toVector.sortBy(_._1) do
      val (bytes, ns, worked) = (all.map(_._2).sum, all.map(_._3).sum, all.map(_._4).sum)
      println(
        s"$name: $calls answers of $megabytes MiB, ${(bytes.toDouble / ns).fixed(2)} GB/s, $bytes bytes, " +
          s"${(worked.toDouble / bytes).fixed(2)} s of processor time a GB, best ${all.map(one =>
              one._2.toDouble / one._3
            ).max.fixed(2)} GB/s"
      )

  private val machine = ManagementFactory.getPlatformMXBean(classOf[OperatingSystemMXBean])

  /** Processor time of client, server and observer together. */
  private def processorNs = machine.getProcessCpuTime

  /** Two clients of one server: one directly, one through the observer. */
  private def between(answerBytes: Int)(measure: (Client, Client) => Unit): Unit =
    val here   = InetAddress.getLoopbackAddress
    val reader = Executors.newSingleThreadExecutor()
    Using.resource(ServerSocket(0, 50, here)): server =>
      Thread.ofPlatform().daemon().start: () =>
        try
          while true do
            val socket = server.accept()
            Thread.ofPlatform().daemon().start(() => serve(socket, answerBytes)): Unit
        catch case _: IOException => () // it was closed
      val at    = Address("127.0.0.1", server.getLocalPort)
      val link  = EmulatedLink(LinkProfile.none, 0, Clock.system)
      val proxy = await(
        ObservingProxy.start(
          AirSimAnalysis(),
          Address("127.0.0.1", 0),
          at,
          link,
          TcpTransport(),
          Clock.system,
          reader
        )
      )
      measure(Client(at.port, answerBytes), Client(proxy.address.port, answerBytes))
      await(proxy.close()): Unit
      val observed = proxy.observed
      println(
        s"the observer counted ${observed.methods.map(_.answerBytes).sum} bytes of " +
          s"${observed.methods.map(_.calls).sum} calls; not looked at: ${observed.notKept}"
      )
    reader.shutdown()

  private def await[A](future: Future[A]) = Await.result(future, 60.seconds)

  private val Call = Array(0x94, 0, 1, 0xa4, 'p', 'i', 'n', 'g', 0x90).map(_.toByte)

  /** The head of an answer: [1, 1, null, bytes]. */
  private def head(answerBytes: Int) =
    ByteBuffer.allocate(9).put(Array(0x94, 1, 1, 0xc0, 0xc6).map(_.toByte)).putInt(answerBytes).array

  private def serve(socket: Socket, answerBytes: Int): Unit =
    socket.setTcpNoDelay(true)
    val (in, out) = (DataInputStream(socket.getInputStream), socket.getOutputStream)
    val call      = Array.ofDim[Byte](Call.length)
    val answer    = head(answerBytes) ++ Array.ofDim[Byte](answerBytes)
    try
      while true do
        in.readFully(call)
        out.write(answer)
    catch case _: IOException => () // its client has left

  private final class Client(port: Int, answerBytes: Int):
    private val socket            = Socket(InetAddress.getLoopbackAddress, port)
    private val in                = socket.getInputStream
    private val out: OutputStream = socket.getOutputStream
    private val buffer            = Array.ofDim[Byte](1 << 20)
    private val whole             = answerBytes + 9L
    socket.setTcpNoDelay(true)

    /** Makes one call and returns the number of bytes of its answer. */
    def call(): Long =
      // The id is always 1: one call at a time.
      out.write(Call.updated(2, 1.toByte))
      var left = whole
      while left > 0 do
        val read = in.read(buffer, 0, buffer.length.toLong.min(left).toInt)
        if read < 0 then throw EOFException(s"$left bytes of an answer are missing")
        left -= read
      whole

    def timed(): Long =
      val startedAt = System.nanoTime()
      call(): Unit
      System.nanoTime() - startedAt
