package skein.bench

import java.util.concurrent.atomic.AtomicInteger
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.Duration
import scala.concurrent.{Await, ExecutionContext, Promise}
import scala.sys.process.*
import skein.airsim.*
import skein.link.{Address, TcpTransport, Transport}
import skein.rpc.{RpcClient, RpcSettings}
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.units.Clock

/** How fast are kinematics requests to the built-in simulator: by our typed client, in sequence and
  * pipelined, and by the official Python client, one after the other in one run. The witness is the last
  * altitude read.
  *
  * Arguments: seconds per row (default 5), and the interpreter of a virtual environment in which the official
  * client is installed (the test of the official client makes one in the user's cache; `PYTHONPATH` must name
  * its compatibility file's folder, simulator/src/test/resources/airsim-python); without it, that row is left
  * out.
  */
object KinematicsPeers:

  def main(args: Array[String]): Unit =
    given system: ActorSystem = ActorSystem("bench")
    val seconds               = args.headOption.fold(5.0)(_.toDouble)
    val transport             = TcpTransport()
    val settings              = SimulatorSettings(address = Address("127.0.0.1", 0))
    val server = Await.result(SimulatorServer.start(settings, transport, Clock.system), Duration.Inf)
    try measure(server, transport, seconds, args.lift(1))
    finally Await.result(system.terminate(), Duration.Inf): Unit

  private def measure(
      server: SimulatorServer,
      transport: Transport,
      seconds: Double,
      python: Option[String]
  )(using
      ActorSystem
  ): Unit =
    println("row                              per second   p50 us   p99 us   witness")
    for (connections, outstanding) <- Seq((1, 1), (1, 50), (4, 200)) do
      val rpc =
        RpcClient(transport, server.address, Clock.system, RpcSettings(controlConnections = connections))
      val client = AirSimClient(rpc)
      val drone  = Multirotor(client, WorldSettings.SimpleFlight)
      ours(drone, outstanding, math.min(seconds, 3)): Unit // for the compiler
      show(s"skein, $connections connections, $outstanding calls", ours(drone, outstanding, seconds))
      Await.result(client.close(), Duration.Inf): Unit
    for interpreter <- python do
      val port   = server.address.port.toString
      val script = "bench/python/kinematics.py"
      show(
        "official Python client",
        Seq(interpreter, script, port, WorldSettings.SimpleFlight, seconds.toString).!!.trim
      )

  /** Keeps `outstanding` requests under way; rate, p50 and p99 in us, witness. */
  private def ours(drone: Multirotor, outstanding: Int, seconds: Double): String =
    given ExecutionContext = ExecutionContext.parasitic
    val latencies          = Latencies()
    val finished           = Promise[Double]()
    val running            = AtomicInteger(outstanding)
    val started            = System.nanoTime()
    val until              = started + (seconds * 1e9).toLong

    def next(): Unit =
      val at = System.nanoTime()
      drone
        .groundTruth()
        .foreach: answer =>
          latencies.add(System.nanoTime() - at)
          if System.nanoTime() < until then next()
          else if running.decrementAndGet() == 0 then
            finished.success(answer.fold(error => sys.error(error.message), _.positionNed.z))

    for _ <- 1 to outstanding do next()
    val altitude = Await.result(finished.future, Duration.Inf)
    val rate     = latencies.count / ((System.nanoTime() - started) * 1e-9)
    f"$rate%.0f ${latencies.quantile(0.5) / 1000}%d ${latencies.quantile(0.99) / 1000}%d $altitude%.3f"

  private def show(row: String, figures: String): Unit =
    val columns = figures.split(' ')
    println(f"$row%-32s ${columns(0)}%10s ${columns(1)}%8s ${columns(2)}%8s ${columns(3)}%9s")
