package skein.simulator

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.io.Source
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.{Address, TcpTransport}
import skein.testing.{Conclusive, Lengthy, PythonEnvironment, Waiting}
import skein.units.*

/** Cosys-AirSim's client, the unmodified `cosysairsim` package of PyPI, flies the built-in simulator over a
  * real socket. Runs if Python can install that package; it fetches it once per user.
  */
class CosysClientLiveSuite extends munit.FunSuite, Conclusive, Lengthy, Waiting:
  private given system: ActorSystem = ActorSystem("cosys-client")

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private val vehicles = Vector(VehicleSettings("Drone"))

  test("Cosys-AirSim's client finds its version, flies, and takes images and detections"):
    CosysClient.python(): Unit
    conclusive:
      val settings = SimulatorSettings(WorldSettings(vehicles), Address("127.0.0.1", 0), speed = 5)
      val server   = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
      try
        val (status, output) = CosysClient.run("fly_cosys.py", s"${server.address.port}")
        println(output)
        assertEquals(status, 0, output)
        assert(output.linesIterator.toSeq.lastOption.exists(_.startsWith("PASSED")), output)
      finally
        val _ = Await.result(server.close(), 10.seconds)

  test("Cosys-AirSim's client calls what methods.txt lists"):
    val (status, output) = CosysClient.run("../airsim-python/list_methods.py", "cosysairsim")
    assertEquals(status, 0, output)
    val listed = Source.fromResource("cosys-python/methods.txt")
    try assertEquals(output.linesIterator.toSeq, listed.getLines().toSeq)
    finally listed.close()

private[simulator] val CosysClient = PythonEnvironment(
  imports = "cosysairsim",
  scripts = Some("/cosys-python/fly_cosys.py"),
  Seq("cosysairsim==3.5.0")
)
