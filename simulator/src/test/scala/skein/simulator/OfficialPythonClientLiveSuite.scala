package skein.simulator

import java.io.File
import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.io.Source
import scala.sys.process.{Process, ProcessLogger}
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.{Address, TcpTransport}
import skein.units.*

/** The proof that the built-in simulator speaks AirSim's wire: the official client, the unmodified `airsim` package of
  * PyPI, flies it over a real socket. Runs where Python can install that package; it fetches it once per user.
  */
class OfficialPythonClientLiveSuite extends munit.FunSuite:
  override val munitTimeout: Duration = 5.minutes

  private given system: ActorSystem = ActorSystem("official-python-client")

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private val vehicles = Vector(VehicleSettings("Evader"), VehicleSettings("Pursuer", Vector3(-21, 0, 0)))

  /** The pursuer carries a lidar, and a distance sensor that looks down. */
  private val text =
    val settings = ujson.read(WorldSettings.render(vehicles))
    settings("Vehicles")("Pursuer")("Sensors") = ujson.Obj(
      "Lidar" -> ujson.Obj("SensorType" -> 6, "Enabled" -> true, "Z" -> -1),
      "Down"  -> ujson.Obj("SensorType" -> 5, "Enabled" -> true, "Pitch" -> -90)
    )
    settings.render()

  test("the official Python client flies a square, reads every sensor, pauses, steps, lands and resets"):
    fly("fly_square.py")

  test("the official Python client flies as AirSim's examples do, and works scene, cameras and markers"):
    fly("fly_examples.py")

  test("the official Python client calls what methods.txt lists"):
    val (status, output) = OfficialPythonClient.run(client(), "list_methods.py")
    assertEquals(status, 0, output)
    val listed = Source.fromResource("airsim-python/methods.txt")
    try assertEquals(output.linesIterator.toSeq, listed.getLines().toSeq)
    finally listed.close()

  private def client(): Path =
    val python = OfficialPythonClient.install()
    assume(python.isRight, s"the official client cannot be installed here: ${python.swap.getOrElse("")}")
    python.toOption.get

  private def fly(script: String): Unit =
    val python   = client()
    val settings = SimulatorSettings(
      WorldSettings(vehicles, text = text),
      Address("127.0.0.1", 0),
      speed = 5
    )
    val server = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
    try
      val (status, output) = OfficialPythonClient.run(python, script, s"${server.address.port}")
      println(output)
      assertEquals(status, 0, output)
      val passed = output.linesIterator.toSeq.lastOption.getOrElse("")
      assert(passed.matches("PASSED [0-9]{2,} checks in .* s"), passed)
      assertEquals(server.behind, Span.Zero)
    finally
      val _ = Await.result(server.close(), 10.seconds)

/** The official client in a virtual environment of its own, kept in the user's cache under the versions' names. */
private object OfficialPythonClient:
  private val client    = Seq("msgpack-rpc-python==0.4.1", "tornado==4.5.3")
  private val airsim    = "airsim==1.8.1"
  private val resources = Path.of(getClass.getResource("/airsim-python/fly_square.py").toURI).getParent

  /** The environment's Python, or why there is none. */
  def install(): Either[String, Path] =
    val cache =
      Option(System.getenv("XDG_CACHE_HOME")).fold(Path.of(sys.props("user.home"), ".cache"))(Path.of(_))
    val home =
      cache.resolve("skein").resolve((airsim +: client).mkString("python-", "-", "").replace("==", "-"))
    val bin = home.resolve("bin").resolve("python")
    if imports(bin) then Right(bin)
    else
      for
        _ <- ran("python3", "-m", "venv", "--clear", home.toString)
        _ <- pip(bin, "setuptools", "wheel", "msgpack", "numpy")
        _ <- pip(bin, ("--no-deps" +: client)*)
        // Its set-up imports the client itself, so it needs the other packages in sight.
        _ <- pip(bin, "--no-deps", "--no-build-isolation", airsim)
        _ <- Either.cond(imports(bin), (), "it is installed but cannot be imported")
      yield bin

  def run(python: Path, script: String, arguments: String*): (Int, String) =
    val output  = StringBuilder()
    val command = Seq(python.toString, "-u", resources.resolve(script).toString) ++ arguments
    val status  = process(command).!(ProcessLogger(line => output.append(line).append('\n'): Unit))
    (status, output.toString)

  private def imports(python: Path): Boolean =
    Files.exists(python) && ran(python.toString, "-c", "import airsim").isRight

  private def pip(python: Path, packages: String*): Either[String, Unit] =
    ran(Seq(python.toString, "-m", "pip", "install", "--quiet", "--disable-pip-version-check") ++ packages*)

  private def ran(command: String*): Either[String, Unit] =
    val output = StringBuilder()
    try
      val status = process(command).!(ProcessLogger(line => output.append(line).append('\n'): Unit))
      Either.cond(status == 0, (), s"${command.mkString(" ")}: ${output.toString.takeRight(500)}")
    catch case e: java.io.IOException => Left(e.getMessage)

  private def process(command: Seq[String]) =
    Process(command, Option.empty[File], "PYTHONPATH" -> resources.toString)
