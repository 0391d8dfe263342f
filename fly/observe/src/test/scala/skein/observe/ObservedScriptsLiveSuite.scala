package skein.observe

import java.nio.file.{Files, Path}
import java.util.concurrent.Executors
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.airsim.{AirSimClient, Vehicles, WorldSettings}
import skein.flight.Preparation
import skein.link.*
import skein.measure.Distribution
import skein.rpc.RpcClient
import skein.scenario.PaperDuel
import skein.signal.LatencyProfile
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.{Conclusive, Lengthy, PythonEnvironment, Waiting}
import skein.units.*

/** Users' scripts with AirSim's own Python client, each with a fault in its timing, run through the observer.
  * The diagnosis must state the fault, and the ages must be those that the script itself knows on the
  * simulator's clock.
  */
class ObservedScriptsLiveSuite extends munit.FunSuite, Conclusive, Lengthy, Waiting:
  private given system: ActorSystem = ActorSystem("observed-scripts")

  override def afterAll(): Unit = await(system.terminate()): Unit

  private def await[A](future: Future[A]): A = Await.result(future, 60.seconds)

  private val fleet    = PaperDuel(pairs = 2)
  private val vehicles = fleet.agents.map(Vehicles.settings)

  private lazy val root =
    Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).find(at =>
      Files.exists(at.resolve("ARCHITECTURE.md"))
    ).get

  private lazy val scripts = root.resolve("fly/observe/src/test/resources/airsim-scripts")

  private val anyPort = Address("127.0.0.1", 0)

  private val client = PythonEnvironment.ofAirSim()

  private def parsed(text: String) =
    LatencyProfile.parse(text, Left(_)).fold(error => fail(error.message), identity)

  /** The observations, and the ages that the script knows, ms. */
  private def observe(script: String, link: LatencyProfile): (observed: Observed, inside: Distribution) =
    val (clock, transport) = (Clock.system, TcpTransport())
    val settings           = SimulatorSettings(
      WorldSettings.of(vehicles),
      anyPort
    )
    val reader = Executors.newSingleThreadExecutor()
    val server = await(SimulatorServer.start(settings, transport, clock))
    try
      val beside = AirSimClient(RpcClient(transport, server.address, clock))
      assertEquals(await(Preparation(beside, clock).place(fleet.fleet)).map(_.size), Right(4))
      await(beside.close()): Unit
      val emulated = EmulatedLink(LinkProfile.symmetric(link), 1, clock)
      val proxy    =
        await(ObservingProxy.start(
          AirSimAnalysis(),
          anyPort,
          server.address,
          emulated,
          transport,
          clock,
          reader
        ))
      val program = OutsideProgram.start(
        Seq(
          client.python().toString,
          scripts.resolve(script).toString,
          s"${proxy.address.port}",
          s"$Seconds"
        ),
        Map(
          "PYTHONPATH"         -> s"${root.resolve("vehicles/simulator/src/test/resources/airsim-python")}",
          "SIMULATOR_CLOCK_NS" -> s"${clock.now().toNanos - System.nanoTime()}"
        )
      ).fold(fail(_), identity)
      program.await(Span.ofSeconds(10 * Seconds))
      program.stop()
      await(proxy.close()): Unit
      assertEquals(program.exit, Some(0), program.printed)
      val ages = ujson.read(program.lastLine.getOrElse("[]")).arr.map(_.num)
      (observed = proxy.observed, inside = Distribution.of(ages).getOrElse(fail(program.printed)))
    finally
      await(server.close()): Unit
      reader.shutdown()

  for
    (script, limit, fault) <- Seq(
      ("blocking_images.py", "", "images in the control loop"),
      ("blocking_team.py", "", "reads in turn"),
      ("threads_moves.py", "", "many moves unanswered"),
      ("two_clients.py", "", "moves left running"),
      ("asyncio_images.py", "rate:10mbit/1MB,", "images fill the link")
    )
    link <- Seq("direct", "vpn")
  do
    test(s"$script over $link: '$fault' is found, and ages are the script's own"):
      client.python(): Unit
      conclusive:
        val (observed, inside) = observe(script, parsed(limit + link))
        val vehicle            = observed.vehicles.find(_.name == "Evader1").get
        val told               = vehicle.ownAgeMs.get
        val found              = Diagnosis.of(observed)
        println(
          f"$script $link: ${vehicle.commands} commands, told ${told.median}%.1f ± ${vehicle.boundMs.get}%.1f ms, " +
            f"inside ${inside.median}%.1f ms; found ${found.map(_.name).mkString(", ")}"
        )
        assert(found.exists(_.name == fault), found.mkString("\n"))
        assert(math.abs(told.median - inside.median) <= vehicle.boundMs.get + Apart, s"$told $inside")
        assertEquals(observed.lost, Vector.empty)

  private val Seconds = 10

  /** Time from the script's reading of the clock to the command's passing, ms. */
  private val Apart = 5.0
