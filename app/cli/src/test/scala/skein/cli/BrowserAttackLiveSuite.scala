package skein.cli

import java.util.Base64
import java.util.concurrent.ConcurrentLinkedQueue
import org.apache.pekko.actor.ActorSystem
import scala.collection.immutable.ArraySeq
import scala.concurrent.ExecutionContext
import scala.util.Using
import skein.airsim.{AirSimClient, WorldSettings}
import skein.blocks.Ledger
import skein.cluster.CoordinatorNode
import skein.flight.SolvedFlight
import skein.hil.AutopilotKind
import skein.link.*
import skein.observe.{AirSimAnalysis, ObservingProxy}
import skein.record.Samples
import skein.report.PaperReport
import skein.rpc.RpcClient
import skein.scenario.Scenarios
import skein.signal.LatencyProfile
import skein.simulator.{HilSettings, MavlinkSettings, SimulatorServer, SimulatorSettings}
import skein.solver.{SolverMessage, SolverMessageCodec, SolverServer}
import skein.testing.{Lengthy, TemporaryFolders, Waiting}
import skein.units.*
import skein.view.*

/** A page of another site, in a real browser, attacks every port that this program opens. */
class BrowserAttackLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy, Waiting:
  private given system: ActorSystem = ActorSystem("BrowserAttackLiveSuite")
  private given Scenarios           = PaperReport.scenarios

  override def afterAll(): Unit = Edge.await(system.terminate()): Unit

  private def needed[A](tool: Either[String, A]): A =
    tool.left.foreach(why => assume(false, why))
    tool.toOption.get

  private val free = Address("127.0.0.1", 0)

  /** Calls of MessagePack-RPC with an observable effect. */
  private val calls: Array[Byte] =
    def text(said: String) = (0xa0 | said.length).toByte +: said.getBytes("US-ASCII")
    Array[Byte](0x94.toByte, 0, 1) ++ text("enableApiControl") ++ Array[Byte](
      0x92.toByte,
      0xc3.toByte
    ) ++ text("") ++
      Array[Byte](0x94.toByte, 0, 2) ++ text("simPause") ++ Array[Byte](0x91.toByte, 0xc3.toByte)

  folder.test(
    "a page of another site can read nothing from any port, and its requests have no effect"
  ): out =>
    val (packages, browser) = (needed(JavaScriptTools.packages), needed(JavaScriptTools.browser))
    val transport           = TcpTransport()
    def simulator(mavlink: Option[MavlinkSettings], hil: Option[HilSettings]) =
      Edge.await(SimulatorServer.start(
        SimulatorSettings(WorldSettings.Default, free, mavlink = mavlink, hil = hil),
        transport,
        Clock.system
      ))
    val plain = simulator(Some(MavlinkSettings(listen = Some(free))), None)
    val flown = simulator(None, Some(HilSettings(AutopilotKind.Px4, Vector(free))))
    val acted = ConcurrentLinkedQueue[FlightControl]()
    val show  = LiveShow(
      Samples.heading,
      Feed(),
      controls = FlightControl.values.map(control => control -> (() => acted.add(control): Unit)).toMap
    )
    val shows = Shows()
    shows.add(show)
    val view = Edge.await(ViewServer.start(
      shows,
      Clock.system,
      ExecutionContext.global,
      port = 0,
      token = Token("right")
    ))
    val desk   = SolvedFlight.desk()
    val solver = Edge.await(SolverServer.start(free, transport, desk, Clock.system))
    val link   = EmulatedLink(LinkProfile.symmetric(LatencyProfile.direct), 1, Clock.system)
    val proxy  = Edge.await(LinkProxy.start(free, plain.address, link, transport))
    val direct = EmulatedLink(LinkProfile.none, 1, Clock.system)
    val reader = ExecutionContext.global
    val seen   =
      Edge.await(ObservingProxy.start(
        AirSimAnalysis(),
        free,
        plain.address,
        direct,
        transport,
        Clock.system,
        reader
      ))
    Using.resource(Ledger.open(
      out.resolve(Ledger.Name),
      ArraySeq.fill[Byte](32)(0)
    ).fold(fail(_), identity)): ledger =>
      val coordinator = CoordinatorNode
        .start(free, None, ArraySeq.empty[Byte], ledger)(_ => ())
        .fold(fail(_), identity)
      val word    = SolverMessageCodec.bytes(SolverMessage.Goodbye(5))
      val goodbye = Array[Byte](0, 0, 0, word.length.toByte) ++ word
      val ports   = Seq(
        ("rpc", plain.address.port, calls),
        ("mavlink", plain.peerAddresses.head.port, calls),
        ("hil", flown.peerAddresses.head.port, calls),
        ("rpc beside hil", flown.address.port, calls),
        ("link", proxy.address.port, calls),
        ("observe", seen.address.port, calls),
        ("view", view.port, calls),
        ("solver", solver.address.port, goodbye),
        ("coordinator", coordinator.address.port, calls)
      )
      val targets = ports.map((name, port, body) =>
        ujson.Obj("name" -> name, "port" -> port, "body" -> Base64.getEncoder.encodeToString(body))
      )
      val attacked = JavaScriptTools.run(
        280,
        "node",
        JavaScriptTools.script("attack.mjs"),
        packages.toString,
        browser,
        ujson.Arr.from(targets).render()
      )
      val told = ujson.read(attacked.fold(fail(_), identity))
      assertEquals(told("got"), ujson.Arr())
      assert(told("tried").num >= ports.size * 13, told("tried").toString)
      assertEquals((acted.size, show.watching), (0, 0))
      assertEquals((desk.stats.flights, desk.stats.answered), (0, 0L))
      for server <- Seq(plain, flown) do
        val client = AirSimClient(RpcClient(transport, server.address, Clock.system))
        assertEquals(Edge.await(client.isPaused()), Right(false))
      Edge.await(coordinator.close())
    Edge.await(proxy.close()): Unit
    Edge.await(solver.close()): Unit
    Edge.await(view.close()): Unit
    for server <- Seq(plain, flown) do Edge.await(server.close()): Unit
