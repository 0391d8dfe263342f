package skein.simulator

import java.lang.management.ManagementFactory
import java.util.concurrent.atomic.{AtomicInteger, LongAdder}
import java.util.concurrent.locks.LockSupport
import java.util.zip.CRC32
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext, Future}
import skein.airsim.*
import skein.link.{Address, TcpTransport}
import skein.rpc.{RpcClient, RpcSettings}
import skein.scene.SceneFile
import skein.signal.Stamped
import skein.units.*

/** Received images of one camera, with the time from each call to the next. */
private final class Received:
  private val stamps          = CRC32()
  private val exposures       = collection.mutable.HashSet.empty[Long]
  private val latencies       = collection.mutable.ArrayBuffer.empty[Double]
  var images, bytes, repeated = 0L

  def add(frame: Stamped[Image]): Unit = synchronized:
    frame.value.pixels match
      case Pixels.Bgr(pixels) => bytes += pixels.buffer.remaining
      case other              => throw IllegalStateException(s"$other")
    if !exposures.add(frame.validAt.toNanos) then repeated += 1
    images += 1
    latencies += frame.roundTrip.toMillis
    stamps.update(java.nio.ByteBuffer.allocate(8).putLong(frame.validAt.toNanos).array)

  def trips: Vector[Double] = synchronized(latencies.toVector)
  def witness: Long         = synchronized(stamps.getValue)

/** Maximum number of one camera's images in transit. */
private val MostOnTheWay = 4

/** Raw images of 1280 × 720 from the built-in simulator to a client of the same process, over TCP on
  * loopback: four cameras at 60 Hz each, at most four images of each in transit, one connection for each and
  * one for all; then at the greatest possible rate; then by the official Python client, one call for all
  * four, if it can be installed: `simulator/Test/runMain skein.simulator.imageThroughput 60`.
  *
  * Each row states the requested and the received images, how many images repeated an exposure, and as its
  * witness the CRC of all stamps.
  */
@main def imageThroughput(seconds: Int): Unit =
  given system: ActorSystem = ActorSystem("images")
  given ExecutionContext    = ExecutionContext.parasitic
  val cameras               = Vector("front_center", "front_left", "front_right", "bottom_center")
  val vehicles              = Vector(VehicleSettings("Drone"))
  val text                  = ujson.read(WorldSettings.render(vehicles))
  text("CameraDefaults") = ujson.Obj(
    "CaptureSettings" -> ujson.Arr(ujson.Obj("ImageType" -> 0, "Width" -> 1280, "Height" -> 720))
  )
  val settings = SimulatorSettings(
    WorldSettings(vehicles, text = text.render()),
    Address("127.0.0.1", 0),
    scene = SceneFile.named("street").get
  )
  val server  = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
  val process =
    ManagementFactory.getOperatingSystemMXBean.asInstanceOf[com.sun.management.OperatingSystemMXBean]

  /** @param perSecond images per second of each camera; 0: each is requested again when its image has arrived
    */
  def row(name: String, connections: Int, perSecond: Int, lastsS: Double, isShown: Boolean = true): Unit =
    val rpc =
      RpcClient(TcpTransport(), server.address, Clock.system, RpcSettings(bulkConnections = connections))
    val client = AirSimClient(rpc)
    val drone  =
      Await.result(Multirotor.named(client, "Drone"), 10.seconds).fold(e => sys.error(e.toString), identity)
    val came   = cameras.map(_ => Received())
    val failed = LongAdder()

    val onTheWay = cameras.map(_ => AtomicInteger())

    /** Skips the request if too many are in transit already. */
    def askIfFree(camera: Int): Future[Unit] =
      if onTheWay(camera).get >= MostOnTheWay then Future.unit
      else
        onTheWay(camera).incrementAndGet(): Unit
        ask(camera).map(_ => onTheWay(camera).decrementAndGet(): Unit)

    def ask(camera: Int): Future[Unit] = drone.eyes.image(Shot(cameras(camera))).map:
      case Right(frame) => came(camera).add(frame)
      case Left(_)      => failed.increment()

    Await.result(Future.traverse(cameras)(camera => drone.eyes.image(Shot(camera))), 10.seconds): Unit
    val (began, cpu) = (System.nanoTime(), process.getProcessCpuTime)
    var asked        = 0L
    val answers      =
      if perSecond > 0 then
        Vector.tabulate((lastsS * perSecond).toInt): tick =>
          val due = began + tick * 1_000_000_000L / perSecond
          while System.nanoTime() < due do LockSupport.parkNanos(due - System.nanoTime())
          asked += cameras.size
          Future.traverse(cameras.indices)(askIfFree)
      else
        val counts                          = LongAdder()
        def goOn(camera: Int): Future[Unit] =
          if System.nanoTime() - began > lastsS * 1e9 then Future.unit
          else
            counts.increment()
            ask(camera).flatMap(_ => goOn(camera))
        val all = Future.traverse(cameras.indices)(goOn)
        Await.result(all, Duration.Inf): Unit
        asked = counts.sum
        Vector(all)
    Await.result(Future.sequence(answers), 60.seconds): Unit
    val spent  = (System.nanoTime() - began) * 1e-9
    val cores  = (process.getProcessCpuTime - cpu) * 1e-9 / spent
    val images = came.map(_.images).sum
    val bytes  = came.map(_.bytes).sum
    val trips  = came.flatMap(_.trips).sorted
    if isShown then
      println(
        f"$name%-44s $asked%7d asked $images%7d came ${asked - images}%4d lost ${came.map(_.repeated).sum}%3d repeated " +
          f"${images / spent}%6.1f/s ${bytes / spent * 1e-9}%5.2f GB/s, round trip p50 " +
          f"${trips(trips.size / 2)}%.1f p99 ${trips((trips.size * 0.99).toInt)}%.1f ms, " +
          f"$cores%.2f cores; stamps ${came.map(_.witness).reduce(_ ^ _)}%08x"
      )
    Await.result(client.close(), 10.seconds): Unit

  def all(): Unit =
    row("", 4, 60, 5, isShown = false)
    row("4 cameras × 60 Hz, a connection for each", 4, 60, seconds)
    row("4 cameras × 60 Hz, one connection", 1, 60, seconds)
    row("4 cameras, as many as come, 4 connections", 4, 0, seconds / 2.0)
    row("4 cameras, as many as come, one connection", 1, 0, seconds / 2.0)
    OfficialPythonClient.install() match
      case Left(reason) => println(s"the official Python client cannot be installed here: $reason")
      case Right(_)     =>
        val (status, output) =
          OfficialPythonClient.run("image_rate.py", s"${server.address.port}", s"${seconds / 2.0}")
        println(if status == 0 then output.trim else s"the official Python client: $status: $output")
    println(f"simulated time that the simulator left out: ${server.behind.toMillis}%.0f ms")

  try all()
  finally
    Await.result(server.close(), 10.seconds): Unit
    Await.result(system.terminate(), 20.seconds): Unit
