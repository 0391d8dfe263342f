package skein.simulator

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.io.Source
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.{Address, TcpTransport}
import skein.testing.{Conclusive, Lengthy, PythonEnvironment, Waiting}
import skein.units.*

/** Proof that the built-in simulator speaks AirSim's protocol: the official client, the unmodified `airsim`
  * package of PyPI, flies it over a real socket. Runs if Python can install that package; it fetches it once
  * per user.
  */
class OfficialPythonClientLiveSuite extends munit.FunSuite, Conclusive, Lengthy, Waiting:
  private given system: ActorSystem = ActorSystem("official-python-client")

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private val vehicles = Vector(VehicleSettings("Evader"), VehicleSettings("Pursuer", Vector3(-21, 0, 0)))
  private val mixed    = vehicles.take(1) :+
    VehicleSettings("Car", Vector3(0, 40, 0), vehicleType = WorldSettings.PhysXCar)

  /** Settings in which the pursuer carries a lidar, and a distance sensor that looks down. */
  private val text =
    val settings = ujson.read(WorldSettings.render(vehicles))
    settings("Vehicles")("Pursuer")("Sensors") = ujson.Obj(
      "Lidar" -> ujson.Obj("SensorType" -> 6, "Enabled" -> true, "Z" -> -1),
      "Down"  -> ujson.Obj("SensorType" -> 5, "Enabled" -> true, "Pitch" -> -90)
    )
    settings.render()

  test("the official Python client flies a square, reads every sensor, pauses, steps, lands and resets"):
    fly("fly_square.py")

  test("the official Python client runs AirSim's examples, and uses scene, cameras and markers"):
    fly("fly_examples.py")

  test("the official Python client drives a car as AirSim's example does, in a world with a multirotor"):
    fly("drive_car.py", WorldSettings.of(mixed))

  test("the official Python client calls what methods.txt lists"):
    val (status, output) = OfficialPythonClient.run("list_methods.py", "airsim")
    assertEquals(status, 0, output)
    val listed = Source.fromResource("airsim-python/methods.txt")
    try assertEquals(output.linesIterator.toSeq, listed.getLines().toSeq)
    finally listed.close()

  private def fly(script: String, world: WorldSettings = WorldSettings(vehicles, text = text)): Unit =
    OfficialPythonClient.python(): Unit
    conclusive(flyOnce(script, world))

  private def flyOnce(script: String, world: WorldSettings): Unit =
    val settings = SimulatorSettings(world, Address("127.0.0.1", 0), speed = 5)
    val server   = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
    try
      val (status, output) = OfficialPythonClient.run(script, s"${server.address.port}")
      println(output)
      assertEquals(status, 0, output)
      val passed = output.linesIterator.toSeq.lastOption.getOrElse("")
      assert(passed.matches("PASSED [0-9]{2,} checks in .* s"), passed)
      assertEquals(server.behind, Span.Zero)
    finally
      val _ = Await.result(server.close(), 10.seconds)

private[simulator] val OfficialPythonClient =
  PythonEnvironment.ofAirSim(scripts = Some("/airsim-python/fly_square.py"))
