package skein.cli

import java.nio.file.Files
import org.apache.pekko.actor.ActorSystem
import skein.link.{Address, TcpTransport}
import skein.scenario.Scenarios
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.Clock

/** Real sockets on loopback and the real clock. */
class LinkCommandsLiveSuite extends munit.FunSuite, Unhurried, TemporaryFolders:
  private given system: ActorSystem = ActorSystem("latency-command")
  private lazy val server           = Edge.await(
    SimulatorServer.start(SimulatorSettings(address = Address("127.0.0.1", 0)), TcpTransport(), Clock.system)
  )

  override def afterAll(): Unit = system.terminate(): Unit

  /** Exit status, standard output, standard error. */
  private def run(command: Command[?], arguments: String*): (Int, String, String) =
    val ran = Ran.of(command.run(arguments))
    (ran.status, ran.out, ran.err)

  folder.test("round trips over an emulated link are printed and drawn"): directory =>
    val (status, printed, told) = run(
      LatencyCommand,
      Seq("--simulator", s"${server.address}", "--link", "constant:60ms") ++
        Seq("--samples", "20", "--period", "20ms", "--out", s"$directory")*
    )
    assertEquals(status, 0, told)
    val mean = "mean ([0-9.]+) ms".r.findFirstMatchIn(printed).map(_.group(1).toDouble)
    // A cold or busy machine may add to single round trips; none is shorter.
    assert(mean.exists(ms => ms >= 60 && ms < 400), printed)
    assert(printed.contains("20 round trips"), printed)
    assert(printed.linesIterator.exists(_.matches(".*ms  █+ \\d+")), printed)
    assert(Files.readString(directory.resolve("latency.svg")).contains("</svg>"))
    assert(Files.size(directory.resolve("latency.png")) > 1000)

  folder.test("without an emulated link, the picture's title is the measured network"): directory =>
    val (status, _, told) = run(
      LatencyCommand,
      Seq("--simulator", s"${server.address}", "--samples", "5", "--period", "20ms", "--out", s"$directory")*
    )
    assertEquals(status, 0, told)
    val picture = Files.readString(directory.resolve("latency.svg"))
    assert(picture.contains(s"to ${server.address}") && !picture.contains("no link added"))

  folder.test("a flight reports vehicles that the simulator lacks before any warm-up"): directory =>
    val scenario          = Seq("--scenario", "formation", "--loop", "stream", "--link", "none")
    val (status, _, told) = run(
      FlyCommand(using Scenarios.ours),
      scenario ++ Seq("--simulator", s"${server.address}", "--out", s"$directory/flights")*
    )
    assertEquals(status, 1)
    assert(told.contains("the simulator has no vehicle '") && told.contains("; it has '"), told)
    assert(!told.contains("warmed up"), told)

  test("without a simulator the error states what to check"):
    val (status, _, told) = run(LatencyCommand, "--simulator", "127.0.0.1:1", "--samples", "1")
    assertEquals(status, 1)
    assert(told.contains("127.0.0.1:1"), told)

  test("a mistake in an option is reported with the option and what was expected"):
    assertEquals(
      run(LatencyCommand, "--period", "soon")._3.trim,
      "skein latency: --period: expected a duration with unit, such as 100ms, got 'soon'"
    )
    assertEquals(
      run(LinkCommand, "--listen", "here", "--to", "127.0.0.1:41451")._3.trim,
      "skein link: --listen: expected HOST:PORT, for example 127.0.0.1:41451, got 'here'"
    )
    val between = Seq("--listen", "127.0.0.1:0", "--to", "127.0.0.1:1")
    assertEquals(
      run(LinkCommand, between ++ Seq("--udp", "--buffer")*)._3.trim,
      "skein link: --buffer: expected without --udp, for a simulator that speaks AirSim's protocol over TCP"
    )
    assertEquals(
      run(LinkCommand, between ++ Seq("--stall-lasts", "2s")*)._3.trim,
      "skein link: --stall-lasts: expected with --stall-every, without which nothing stalls"
    )
    val three = Seq("--profile", "vpn", "--to-server", "none", "--to-client", "direct")
    assert(run(LinkCommand, between ++ three*)._3.startsWith("skein link: --profile: expected without "))
    for (option, more) <- Seq("--profile" -> Nil, "--to-client" -> Seq("--rate", "50mbit")) do
      val told = run(LinkCommand, between ++ Seq(option, "dsl") ++ more*)._3
      assert(told.startsWith(s"skein link: $option: ") && told.contains("vpn-mixed"), told)

  test("a port in use is reported as such"):
    val (status, _, told) = run(LinkCommand, "--listen", s"${server.address}", "--to", "127.0.0.1:1")
    assertEquals(status, 1)
    assert(told.contains(s"port ${server.address.port} of 127.0.0.1 is taken"), told)
