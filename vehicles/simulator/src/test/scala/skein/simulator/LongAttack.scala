package skein.simulator

import java.io.IOException
import java.net.{DatagramPacket, DatagramSocket, InetAddress, InetSocketAddress, Socket}
import java.util.concurrent.ConcurrentLinkedQueue
import scala.jdk.CollectionConverters.*
import scala.util.Random
import skein.airsim.wire.{ImageRequest, Pose, Quaternionr, Vector3r, YawMode}
import skein.hil.SmallAutopilot
import skein.mavlink.{FrameWriter, Heartbeat, ParamRequestList}
import skein.rpc.MessageWriter
import upack.*
import upickle.default.writeMsg

/** All known attacks on `./skein serve`, simultaneously and for any duration, during the calls of an honest
  * client that requests a vehicle's state 20 times per second: its waiting times without attackers, with
  * them, and in the seconds after they had left. A second honest client, of a second `serve` without
  * attackers, shows what the machine's load alone does to these times.
  *
  * Arguments: the ports of RPC, of an autopilot (`--hil px4`), of MAVLink by UDP (`--mavlink`, which is of
  * another `serve`, for one process refuses both) and of `--view`, each 0 for none; seconds of the attack; a
  * seed; and of each further honest client `NAME=PORT`, for example `beside=42200`.
  */
object LongAttack:
  def main(arguments: Array[String]): Unit =
    val Array(rpc, hil, udp, view, seconds, seed) = arguments.take(6).map(_.toInt): @unchecked
    val attack                                    = LongAttack(rpc, hil, udp, view, seed)
    val clients = Honest("attacked", rpc) +: arguments.drop(6).map { case s"$name=$port" =>
      Honest(name, port.toInt)
    }.toSeq
    println(f"${"phase"}%-22s ${"client"}%-8s ${"asked"}%7s ${"p50"}%8s ${"p99"}%8s ${"max"}%8s ms  lost")
    phase(clients, "nobody", 20)
    clients.foreach(_.forget())
    attack.begin()
    for minute <- 1 to (seconds + 59) / 60 do
      phase(clients, s"attack, minute $minute", math.min(60, seconds - (minute - 1) * 60))
      println(attack.told)
    for client <- clients do println(client.row("the whole attack", client.all))
    attack.end()
    for second <- 1 to 10 do phase(clients, s"second $second after", 1)
    phase(clients, "nobody", 20)
    sys.exit(0)

  private def phase(clients: Seq[Honest], name: String, seconds: Int): Unit =
    val end     = System.nanoTime() + seconds * 1_000_000_000L
    val threads = clients.map(client => Thread.ofPlatform().start(() => client.phase(end)))
    threads.foreach(_.join())
    for client <- clients do println(client.row(name, client.latest))

  private val loopback = InetAddress.getLoopbackAddress

  /** Number of connections held open: more than any server accepts. */
  private val MostHeld = 1500

  /** Waiting times in milliseconds, and how many requests were lost with their connection. */
  private final case class Waits(ms: Vector[Double] = Vector.empty, lost: Int = 0):
    def ++(other: Waits): Waits = Waits(ms ++ other.ms, lost + other.lost)

  /** A client that connects again whenever it is disconnected. */
  private final class Honest(name: String, port: Int):
    private var socket = Option.empty[Socket]
    private var id     = 0
    var latest         = Waits()
    var all            = Waits()

    def forget(): Unit = all = Waits()

    private def ask(): Unit =
      val one = socket.filterNot(_.isClosed).getOrElse:
        val fresh = Socket(loopback, port)
        fresh.setTcpNoDelay(true)
        fresh.setSoTimeout(30_000)
        fresh
      socket = Some(one)
      id += 1
      one.getOutputStream.write(request(id -> ("getMultirotorState", Seq(Str("")))))
      // A state is one value of more than a few bytes; it is complete once the last byte has arrived.
      val in    = one.getInputStream
      val first = in.read()
      if first < 0 then throw IOException("closed")
      Thread.sleep(1)
      in.skipNBytes(in.available.toLong)

    /** Sends requests until `end`, in nanoseconds of `System.nanoTime`. */
    def phase(end: Long): Unit =
      latest = Waits()
      while System.nanoTime() < end do
        val begun = System.nanoTime()
        try
          ask()
          latest = latest.copy(ms = latest.ms :+ ((System.nanoTime() - begun) * 1e-6 - 1))
        catch
          case _: IOException =>
            latest = latest.copy(lost = latest.lost + 1)
            socket.foreach(_.close())
            socket = None
        Thread.sleep(math.max(0, 50 - (System.nanoTime() - begun) / 1_000_000))
      all ++= latest

    def row(phase: String, waits: Waits): String =
      val sorted            = waits.ms.sorted
      def at(share: Double) = if sorted.isEmpty then Double.NaN else sorted(((sorted.size - 1) * share).toInt)
      f"$phase%-22s $name%-8s ${sorted.size}%7d ${at(0.5)}%8.2f ${at(0.99)}%8.2f ${at(1)}%8.2f     ${waits.lost}"

  private def request(calls: (Int, (String, Seq[Msg]))*): Array[Byte] =
    val writer = new MessageWriter
    for (id, (method, params)) <- calls do writer.request(id, method, params)
    writer.take().toArray

final private class LongAttack(rpc: Int, hil: Int, udp: Int, view: Int, seed: Long):
  import LongAttack.{loopback, request}
  private val held           = ConcurrentLinkedQueue[AutoCloseable]()
  private val failed         = java.util.concurrent.ConcurrentHashMap[String, Long]()
  @volatile private var ends = false
  private val rounds         = java.util.concurrent.ConcurrentHashMap[String, Long]()

  def told: String =
    rounds.asScala.toSeq.sorted
      .map((name, count) => s"$name $count (${failed.getOrDefault(name, 0L)} failed)")
      .mkString("rounds: ", ", ", "")

  def end(): Unit =
    ends = true
    held.forEach(_.close())

  private def again(name: String, threads: Int = 1)(round: Random => Unit): Unit =
    for thread <- 1 to threads do
      Thread.ofPlatform().daemon().start: () =>
        val random = Random(seed * 1000 + name.hashCode + thread)
        while !ends do
          try round(random)
          catch
            case _: IOException =>
              failed.merge(name, 1L, _ + _): Unit
              Thread.sleep(20)
          rounds.merge(name, 1L, _ + _): Unit
      : Unit

  private def connected(port: Int): Socket =
    val socket = Socket()
    socket.connect(InetSocketAddress(loopback, port), 2000)
    socket.setSoTimeout(2000)
    held.add(socket): Unit
    // Closed ones take descriptors until they are closed here too: an attack that lasts runs out of them.
    while held.size > LongAttack.MostHeld do Option(held.poll()).foreach(_.close())
    socket

  private def using(port: Int)(use: Socket => Unit): Unit =
    val socket = connected(port)
    try use(socket)
    finally
      socket.close()
      held.remove(socket): Unit

  /** Sends calls, and waits for their answers. */
  private def ask(socket: Socket, calls: (String, Seq[Msg])*): Unit =
    socket.getOutputStream.write(request(calls.zipWithIndex.map((call, id) => id -> call)*))
    socket.getInputStream.read(): Unit

  private val long =
    Seq(Float32(1), Float32(0), Float32(-5), Float32(1e6f), Int32(0), writeMsg(YawMode.Still))

  def begin(): Unit =
    val nested = Vector("(.*)*" * 60 + "x", "(a?){900}", "((a+)+)+" * 30, ".*" * 400)
    again("patterns", 2)(random =>
      using(rpc)(ask(_, "simListSceneObjects" -> Seq(Str(nested(random.nextInt(4))))))
    )
    again("pages", 2): random =>
      val methods = Seq("POST", "GET", "OPTIONS", "PUT")
      val ports   = Seq(rpc, hil, view).filter(_ > 0)
      using(ports(random.nextInt(ports.size))): page =>
        val head = s"${methods(random.nextInt(4))} / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".getBytes
        page.getOutputStream.write(head ++ request(1 -> ("simPause", Seq(Bool(true)))))
        page.getInputStream.read(): Unit
    again("silent", 2): _ =>
      connected(rpc): Unit
      Thread.sleep(5)
    again("one word", 2): _ =>
      ask(connected(rpc), "ping" -> Nil)
      Thread.sleep(20)
    again("dripping", 4): _ =>
      using(rpc): one =>
        for byte <- request(1 -> ("ping", Nil)) do
          one.getOutputStream.write(byte)
          Thread.sleep(700)
    again("moves, and leaves")(_ =>
      using(rpc): one =>
        ask(one, "enableApiControl" -> Seq(Bool(true), Str("")))
        one.getOutputStream.write(request((1 to 12).map(_ -> ("moveByVelocityZ", long :+ Str("")))*))
        Thread.sleep(100)
    )
    again("moves, and stays")(_ =>
      using(rpc): one =>
        one.getOutputStream.write(request((1 to 12).map(_ -> ("moveByVelocityZ", long :+ Str("")))*))
        Thread.sleep(10_000)
    )
    again("spawns paths"): random =>
      using(rpc): one =>
        val name    = Str(s"v${random.nextInt(200)}")
        val pose    = writeMsg(Pose(Vector3r(0, random.nextInt(1000).toFloat, -5), Quaternionr(1, 0, 0, 0)))
        val path    = Arr(Seq.fill(9000)(writeMsg(Vector3r(0, 0, -5)))*)
        ask(one, "simAddVehicle"    -> Seq(name, Str("SimpleFlight"), pose, Str("")))
        ask(one, "enableApiControl" -> Seq(Bool(true), name))
        val params  =
          Seq(path, Float32(1), Float32(1e6f), Int32(0), writeMsg(YawMode.Still), Float32(-1), Float32(1))
        one.getOutputStream.write(request(9 -> ("moveOnPath", params :+ name)))
        Thread.sleep(300)
    again("images", 2)(_ =>
      using(rpc)(ask(
        _,
        "simGetImages" -> Seq(
          Arr(Seq.fill(32)(writeMsg(ImageRequest("0", 0, pixels_as_float = false, compress = true)))*),
          Str(""),
          Bool(false)
        )
      ))
    )
    again("deaf", 2): _ =>
      using(rpc): one =>
        one.getOutputStream.write(request((1 to 200).map(_ -> (
          "simGetImage",
          Seq(Str("0"), Int32(0), Str(""), Bool(false))
        ))*))
        Thread.sleep(3000)
    again("noise", 2)(random =>
      using(rpc)(_.getOutputStream.write(Array[Byte](0x94.toByte) ++ random.nextBytes(random.nextInt(3000))))
    )
    again("calls", 2)(_ =>
      using(rpc)(one => ask(one, Seq.fill(200)("getMultirotorState" -> Seq[Msg](Str("")))*))
    )
    if view > 0 then
      again("silent viewers")(_ =>
        connected(view)
        Thread.sleep(20)
      )
      again("deaf viewers", 2): random =>
        using(view): one =>
          val key  = java.util.Base64.getEncoder.encodeToString(random.nextBytes(16))
          val head =
            s"GET / HTTP/1.1\r\nHost: 127.0.0.1:$view\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n" +
              s"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: $key\r\n" +
              "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n"
          one.getOutputStream.write(head.getBytes)
          one.getInputStream.read(): Unit
          one.getOutputStream.write(random.nextBytes(random.nextInt(2000)))
          Thread.sleep(500)
    if hil > 0 then
      again("autopilots", 2): random =>
        using(hil): one =>
          val autopilot = SmallAutopilot()
          one.getOutputStream.write(autopilot.greeting)
          val bytes = new Array[Byte](1 << 16)
          // Answers a few times in lockstep, and then never.
          for _ <- 1 to random.nextInt(50) do
            val count = one.getInputStream.read(bytes)
            if count > 0 then one.getOutputStream.write(autopilot.hear(bytes.take(count)))
          Thread.sleep(2000)
      again("mute autopilots")(_ => using(hil)(_ => Thread.sleep(1000)))
    if udp > 0 then
      again("datagrams", 2): random =>
        val socket = DatagramSocket(0, loopback)
        val writer = FrameWriter(200, 190)
        val bytes  = (Heartbeat(
          6, 8, 0, 0, 4, 3
        ) +: Vector.fill(90)(ParamRequestList(0, 0))).flatMap(writer.write).toArray
        for _ <- 1 to 5 do
          socket.send(DatagramPacket(bytes, bytes.length.min(1400), loopback, udp))
          socket.send(DatagramPacket(random.nextBytes(100), 100, loopback, udp))
        socket.close()
