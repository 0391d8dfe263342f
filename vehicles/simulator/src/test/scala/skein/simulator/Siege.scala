package skein.simulator

import com.typesafe.config.ConfigFactory
import java.io.IOException
import java.net.{InetAddress, Socket}
import java.util.concurrent.atomic.{AtomicBoolean, AtomicLong}
import java.util.concurrent.{ConcurrentHashMap, ConcurrentLinkedQueue, Semaphore}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.util.ByteString
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.jdk.CollectionConverters.*
import scala.util.Random
import skein.link.{Address, TcpTransport}
import skein.rpc.*
import skein.units.*
import upack.{Msg, Null, Str}

/** The built-in simulator besieged over loopback sockets, during the calls of an honest client that polls a
  * vehicle's state: fuzzing by method first, then each attack separately. Every row states the honest
  * client's waiting times during the attack, and after the attackers had left.
  *
  * Three processes, since a greedy client is not in the server's process: this one is the server (with
  * unlimited workers, since endless moves hold AirSim's workers for ever, by its design) and the honest
  * client, the attackers run in a second.
  *
  * The actor system is set as the command `serve` sets its own.
  *
  * Arguments: calls of the fuzz (default 1,000,000), seconds for each attack (default 20), seed (default 1),
  * and the attacks, with commas between (default all of them).
  */
object Siege:
  def main(args: Array[String]): Unit =
    val calls                 = args.headOption.fold(1_000_000)(_.toInt)
    val seconds               = args.lift(1).fold(20)(_.toInt)
    val seed                  = args.lift(2).fold(1L)(_.toLong)
    val attacks               = args.lift(3).fold(Attacks)(_.split(',').toSeq)
    given system: ActorSystem =
      ActorSystem("siege", ConfigFactory.parseString(AsServed).withFallback(ConfigFactory.load()))
    val settings = SimulatorSettings(address = Address("127.0.0.1", 0), overload = Overload.Never)
    val server   = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
    val honest   = Honest(server.address.port)
    println(s"seed $seed; honest client: getMultirotorState every 5 ms; waits in ms")
    println(
      f"${"what"}%-12s ${"polls"}%6s ${"p50"}%6s ${"p99"}%6s " +
        f"${"max"}%7s | 2 s after: ${"p99"}%6s ${"max"}%7s | held MiB"
    )
    def row(what: String)(attack: => String): Unit =
      honest.reset()
      val said   = attack
      val during = honest.reset()
      Thread.sleep(2000)
      val _ = honest.reset()
      Thread.sleep(3000)
      val after = honest.reset()
      val held  = server.stats.mostHeldBytes / 1048576.0
      println(
        f"$what%-12s ${during.length}%6d ${at(during, 0.5)}%6.1f " +
          f"${at(during, 0.99)}%6.1f ${at(during, 1)}%7.1f |            " +
          f"${at(after, 0.99)}%6.1f ${at(after, 1)}%7.1f | $held%.1f of " +
          f"${settings.limits.heldBytes >> 20}  $said"
      )
    row("nobody") { Thread.sleep(5000); "" }
    for attack <- attacks.sortBy(_ != "fuzz") do
      val amount = if attack == "fuzz" then calls else seconds
      row(attack)(s"${child(attack, server.address.port, amount, seed)}; heap ${heapMiB()} MiB")
    println(server.stats)
    println(s"simulation failed: ${server.failed.value}; honest answers wrong: ${honest.wrong}")
    honest.stop()
    Await.result(server.close(), 10.seconds)
    val _ = Await.result(system.terminate(), 20.seconds)

  private val Attacks = Seq("fuzz", "pipelining", "colliding", "unfinished", "idle", "deaf")

  private val AsServed =
    """pekko {
      |  loglevel = WARNING
      |  scheduler.implementation = "skein.link.PreciseScheduler"
      |  stream.materializer.io.tcp.coalesce-writes = 0
      |}""".stripMargin

  private def at(sorted: Array[Double], quantile: Double): Double =
    if sorted.isEmpty then Double.NaN
    else sorted(math.min((quantile * sorted.length).toInt, sorted.length - 1))

  /** Used memory after a garbage collection. */
  private def heapMiB(): Long =
    System.gc()
    (Runtime.getRuntime.totalMemory - Runtime.getRuntime.freeMemory) >> 20

  private def child(attack: String, port: Int, amount: Int, seed: Long): String =
    val java    = ProcessHandle.current.info.command.get
    val command = Seq(
      java,
      "--add-modules",
      "jdk.incubator.vector",
      "-Xmx1g",
      "-cp",
      System.getProperty("java.class.path"),
      "skein.simulator.Attackers",
      attack,
      s"$port",
      s"$amount",
      s"$seed"
    )
    val process = ProcessBuilder(command.asJava).redirectErrorStream(true).start()
    val said    = String(process.getInputStream.readAllBytes())
    val code    = process.waitFor()
    said.linesIterator.filterNot(_.startsWith("WARNING")).mkString(" ") + (if code == 0 then ""
                                                                           else s" EXIT $code")

  /** Polls in a thread of its own; waiting times are in ms. */
  private final class Honest(port: Int):
    private val waits      = ConcurrentLinkedQueue[Double]()
    private val stopped    = AtomicBoolean()
    @volatile var wrong    = 0
    private val connection = Connection(port)
    private val thread     = Thread.ofPlatform().daemon().start: () =>
      var id = 0L
      while !stopped.get do
        val start = System.nanoTime()
        id += 1
        connection.ask(id, "getMultirotorState", Seq(Str("")))
        connection.reply() match
          case RpcMessage.Reply(answered, Null, _) if answered == id => ()
          case _                                                     => wrong += 1
        val _ = waits.add((System.nanoTime() - start) * 1e-6)
        Thread.sleep(5)

    /** Takes the waiting times since the last call, sorted. */
    def reset(): Array[Double] =
      Iterator.continually(Option(waits.poll())).takeWhile(_.nonEmpty).flatten.toArray.sorted

    def stop(): Unit =
      stopped.set(true)
      thread.join()

/** A blocking connection of an attacker. */
private final class Connection(port: Int):
  private val socket  = Socket(InetAddress.getLoopbackAddress, port)
  private val framer  = new Framer()
  private val writer  = new MessageWriter
  private val segment = new Array[Byte](65536)

  def ask(id: Long, method: String, params: Seq[Msg]): Unit =
    writer.request(id, method, params)
    send(writer.take().toArrayUnsafe())

  def send(bytes: Array[Byte]): Unit = socket.getOutputStream.write(bytes)

  /** The next reply; [[IOException]] when closed. */
  def reply(): RpcMessage =
    framer.next() match
      case Framed.Complete(frame)   => RpcMessage.fromServer(frame)
      case Framed.Malformed(reason) => throw IOException(reason)
      case Framed.NeedsMore         =>
        val count = socket.getInputStream.read(segment)
        if count < 0 then throw IOException("closed")
        framer.offer(ByteString.fromArray(segment, 0, count))
        reply()

  def close(): Unit = socket.close()

/** The attackers' process of [[Siege]]; loopback only. Arguments: attack, port, amount, seed. */
object Attackers:
  def main(args: Array[String]): Unit =
    val Array(attack, port, amount, seed) = args: @unchecked
    attack match
      case "fuzz"       => fuzz(port.toInt, amount.toInt, seed.toLong)
      case "pipelining" => many(200, port.toInt, amount.toInt)(pipelining)
      case "colliding"  => many(20, port.toInt, amount.toInt)(colliding)
      case "unfinished" => many(200, port.toInt, amount.toInt)(unfinished)
      case "idle"       => many(256, port.toInt, amount.toInt)(_ => Thread.sleep(200))
      case "deaf"       => many(200, port.toInt, amount.toInt)(deaf)
    // Leaves as a killed program does: with calls in progress.
    Runtime.getRuntime.halt(0)

  /** Opens `connections` connections, each of which acts repeatedly, and connects again when it is closed. */
  private def many(connections: Int, port: Int, seconds: Int)(act: Connection => Unit): Unit =
    val end  = System.nanoTime() + seconds * 1_000_000_000L
    val acts = AtomicLong()
    val lost = AtomicLong()
    val all  =
      for _ <- 1 to connections yield Thread.ofVirtual().start: () =>
        while System.nanoTime() < end do
          try
            val connection = Connection(port)
            try
              while System.nanoTime() < end do
                act(connection)
                val _ = acts.incrementAndGet()
            finally if System.nanoTime() < end then connection.close()
          catch
            case _: IOException =>
              val _ = lost.incrementAndGet()
              Thread.sleep(10)
    Thread.sleep(math.max(0, (end - System.nanoTime()) / 1_000_000))
    println(s"${acts.get} times, $connections connections, closed on them ${lost.get} times")
    val _ = all

  private val burst: Array[Byte] =
    val writer = new MessageWriter
    for id <- 0 until 256 do writer.request(id, "getMultirotorState", Seq(Str("")))
    writer.take().toArray

  private def pipelining(connection: Connection): Unit =
    connection.send(burst)
    for _ <- 0 until 256 do connection.reply()

  private def deaf(connection: Connection): Unit =
    connection.send(burst)

  /** 40,000 keys with equal hashes: those of Aa and BB are equal. */
  private lazy val collisions: Array[Byte] =
    val out  = java.io.ByteArrayOutputStream()
    val keys = Iterator.range(0, 40_000).map(i =>
      (0 until 16).map(bit => if (i >> bit & 1) == 1 then "Aa" else "BB").mkString
    )
    out.write(Array[Byte](
      0x94.toByte,
      0,
      1,
      0xa4.toByte,
      'p',
      'i',
      'n',
      'g',
      0x91.toByte,
      0xde.toByte,
      0x9c.toByte,
      0x40
    ))
    for key <- keys do
      out.write(Array[Byte](0xd9.toByte, 32))
      out.write(key.getBytes)
      out.write(1)
    out.toByteArray

  private def colliding(connection: Connection): Unit =
    connection.send(collisions)
    val _ = connection.reply()

  /** The first 3.9 MB of a message of 4 MB. */
  private val begun: Array[Byte] =
    val bytes = new Array[Byte](3_900_000)
    Array[Byte](
      0x94.toByte,
      0,
      1,
      0xa4.toByte,
      'p',
      'i',
      'n',
      'g',
      0x91.toByte,
      0xc6.toByte,
      0,
      0x3d,
      0x09,
      0
    ).copyToArray(bytes)
    bytes

  private def unfinished(connection: Connection): Unit =
    connection.send(begun)
    val _ = connection.reply()

  private inline val Nudge = 1_000_000_000L

  private def fuzz(port: Int, calls: Int, seed: Long): Unit =
    val lanes   = 8
    val left    = AtomicLong(calls)
    val ended   = AtomicLong()
    val refused = AtomicLong()
    val defects = ConcurrentLinkedQueue[String]()
    val start   = System.nanoTime()
    val threads =
      for lane <- 0 until lanes yield Thread.ofPlatform().start: () =>
        val random     = Random(seed * 1000 + lane)
        val source     = MethodFuzz.Calls(Simulation.methods, "SimpleFlight")
        val connection = Connection(port)
        // Some 80 of the largest messages fit into a server's memory limit for all clients.
        val window = Semaphore(16)
        val mine   = AtomicLong()
        val asked  = ConcurrentHashMap[Long, String]()
        val reader = Thread.ofPlatform().daemon().start: () =>
          while true do
            connection.reply() match
              case RpcMessage.Reply(Nudge, _, _)        => ()
              case RpcMessage.Reply(answered, error, _) =>
                asked.remove(answered): Unit
                ended.incrementAndGet(): Unit
                mine.decrementAndGet(): Unit
                if error != Null then
                  refused.incrementAndGet(): Unit
                  val text = RpcMessage.errorText(error)
                  if MethodFuzz.isDefect(text) && defects.size < 20 then defects.add(text): Unit
                window.release()
              case _ => ()
        // Its own moves wait, or a stepped advance of a day: both are ended.
        def nudge(): Unit =
          connection.ask(Nudge, "simPause", Seq(upack.Bool(false)))
          for name <- source.names do connection.ask(Nudge, "cancelLastTask", Seq(name))
        var id = 0L
        while left.getAndDecrement() > 0 do
          val call = source.random(random)
          while !window.tryAcquire(20, java.util.concurrent.TimeUnit.MILLISECONDS) do nudge()
          id += 1
          mine.incrementAndGet(): Unit
          asked.put(id, s"${call.method}${call.params.mkString("(", ", ", ")").take(200)}"): Unit
          connection.ask(id, call.method, call.params)
        var patience = 500
        while mine.get > 0 && patience > 0 do
          nudge()
          Thread.sleep(20)
          patience -= 1
        if mine.get > 0 then defects.add(s"never answered: ${asked.values.asScala.mkString(", ")}"): Unit
        val _ = reader
    threads.foreach(_.join())
    val took = (System.nanoTime() - start) * 1e-9
    println(
      f"${ended.get} calls ended, ${refused.get} of them refused, in $took%.0f " +
        f"s; defects: ${defects.asScala.toSeq.distinct.mkString("; ")}"
    )
