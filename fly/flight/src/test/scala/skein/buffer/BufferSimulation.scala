package skein.buffer

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Flow, Source}
import org.apache.pekko.util.ByteString
import scala.collection.mutable.ArrayBuffer
import scala.concurrent.Future
import skein.airsim.*
import skein.link.*
import skein.policy.Action
import skein.port.CommandPlan
import skein.rpc.{Framed, Framer, RpcClient, RpcError, RpcMessage}
import skein.signal.LatencyProfile
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime

/** The external buffer, which uses the built-in simulator's ordinary moves, in virtual time. The simulator's
  * own buffer is the oracle.
  */
class BufferSimulation extends munit.FunSuite, Unhurried:

  /** A call that has reached the simulator. */
  private final case class Called(at: Instant, method: String)

  /** A simulator, a link with a buffer in front of it, and clients of both.
    *
    * @param lan link between the buffer and the simulator
    * @param speed rate of the simulator's clock relative to the machine's
    */
  private final class Bench(lan: LatencyProfile, speed: Double)(using val system: ActorSystem):
    val clock           = Clock.ofNanos(VirtualTime.clock(system))
    private val near    = LinkProfile.symmetric(lan)
    private val network = MemoryNetwork(NetworkPlan(links = Map(("beside", "simulator") -> near)), 1, clock)
    private val beside  = network.host("beside")
    private val at      = Address("simulator", 41451)
    val calls: ArrayBuffer[Called] = ArrayBuffer.empty

    private val listened: Transport = new Transport:
      private val own          = network.host("simulator")
      def connect(to: Address) = own.connect(to)
      def listen(at: Address)  = own.listen(at).map: incoming =>
        val framer = new Framer()
        val note   = Flow[ByteString].map: bytes =>
          framer.offer(bytes)
          Iterator
            .continually(framer.next())
            .takeWhile(_ != Framed.NeedsMore)
            .foreach:
              case Framed.Complete(frame) => RpcMessage.fromClient(frame) match
                  case RpcMessage.Request(_, method, _) => calls += Called(clock.now(), method)
                  case _                                => ()
              case _ => ()
          bytes
        incoming.copy(flow = incoming.flow.via(note))

    val server = SimulatorServer.start(
      SimulatorSettings(WorldSettings.of(Vector(VehicleSettings("Drone"))), at, speed = speed),
      listened,
      clock
    )
    val buffer = SimulatorBuffer.start(at, beside, clock)
    val proxy  = LinkProxy.start(
      Address("beside", 41452),
      at,
      EmulatedLink(LinkProfile.none, 1, clock),
      beside,
      beside = () => buffer.passing()
    )

    def client(to: Address): AirSimClient = AirSimClient(RpcClient(beside, to, clock))

    def direct(to: Address): Flow[ByteString, ByteString, ?] = beside.connect(to)

    def later[A](ms: Double)(act: => Future[A]): Future[A] = after(Span.ofMillis(ms).toDuration)(act)

  private def on[A](lan: String = "none", speed: Double = 1)(use: Bench => Future[A]): A = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem = system
      val profile       = LatencyProfile.parse(lan, Left(_)).fold(_ => fail(lan), identity)
      val bench         = Bench(profile, speed)
      import bench.system.dispatcher
      for
        server <- bench.server
        proxy  <- bench.proxy
        result <- use(bench)
        _      <- proxy.close()
        _      <- bench.buffer.close()
        _      <- server.close()
      yield result
    .value

  private def right[E, A](answer: Either[E, A]): A = answer.fold(error => fail(error.toString), identity)

  /** Sends plans of turns, a new one every 100 ms, of which some do not arrive, and reads the position every
    * 50 ms over a separate connection.
    *
    * @param through the address that plans are sent to
    */
  private def flown(bench: Bench, through: Address, speed: Double): Future[Vector[Vector3]] =
    import bench.system.dispatcher
    val direct = bench.client(Address("simulator", 41451))
    val client = bench.client(through)
    def watched(left: Int, before: Vector[Vector3]): Future[Vector[Vector3]] =
      if left == 0 then Future.successful(before)
      else
        Multirotor(direct, "Drone").kinematics().flatMap: read =>
          bench.later(50 / speed)(watched(left - 1, before :+ right(read).value.positionNed))
    for
      drone <- Multirotor.named(client, "Drone").map(right)
      _     <- drone.enableApiControl().map(right)
      _     <- drone.hoverAt(VehiclePose(Vector3(0, 0, -20), Quaternion.Identity)).map(right)
      start <- drone.kinematics().map(right)
      sending = Future.traverse((0 until 80).filter(_ % 7 < 4).toVector): number =>
        bench.later(100 * number / speed):
          val moves = Vector.tabulate(16): index =>
            val turn = 0.3 * (number + index)
            val at   = start.validAt + Span.ofMillis(400 + 100.0 * (number + index))
            val act  = Action.VelocityAt(8 * math.cos(turn), 8 * math.sin(turn), Metres(-20))
            (at = at, action = act: Action)
          drone.followPlan(number, CommandPlan(number, moves)).get.map(right)
      places <- watched(220, Vector.empty)
      _      <- sending
      _      <- client.close()
      _      <- direct.close()
    yield places

  for (lan, speed) <- Seq("none" -> 1.0, "constant:1ms" -> 1.0, "none" -> 4.0) do
    test(s"a vehicle flies as with the simulator's own buffer; near link $lan, clock $speed times as fast"):
      val own              = on(lan, speed)(bench => flown(bench, Address("simulator", 41451), speed))
      val (places, counts) = on(lan, speed): bench =>
        import bench.system.dispatcher
        flown(bench, Address("beside", 41452), speed).map((_, bench.buffer.counts))
      val off = own.zip(places).map((one, other) => (one - other).norm)
      assert(off.max < 0.05 * speed, s"${off.max} m apart")
      assert(own.map(_.norm).max > 5, "it hardly flew")
      assertEquals((counts.plans, counts.refusedPlans, counts.failedMoves), (47L, 0L, 0L))
      assert(counts.moves > 80, counts.toString)

  test(
    "moves arrive at most half a round trip and the handover late, and at most two are unanswered"
  ):
    val (calls, start, counts) = on("constant:1ms"): bench =>
      import bench.system.dispatcher
      val client = bench.client(Address("beside", 41452))
      for
        drone <- Multirotor.named(client, "Drone").map(right)
        _     <- drone.enableApiControl().map(right)
        _     <- drone.hoverAt(VehiclePose(Vector3(0, 0, -20), Quaternion.Identity)).map(right)
        start <- drone.kinematics().map(right)
        at    = start.validAt + Span.ofMillis(50)
        moves = Vector.tabulate(16)(index =>
          (at = at + Span.ofMillis(100.0 * index), action = Action.VelocityAt(index, 0, Metres(-20)): Action)
        )
        _ <- drone.followPlan(1, CommandPlan(1, moves)).get.map(right)
        _ <- bench.later(3000)(Future.unit)
        _ <- client.close()
      yield (bench.calls.toVector.filter(_.method == "moveByVelocityZ"), at, bench.buffer.counts)
    assertEquals(calls.size, 16)
    for (call, index) <- calls.zipWithIndex do
      // The simulator's clock is the one that drives it.
      val late = call.at.since(start).toMillis - 100 * index
      assert(late >= 0 && late < 3, s"move $index was $late ms late")
    assert(counts.latest < Span.ofMillis(3), counts.toString)

  test("the simulator receives no plan, and plans are refused as by the simulator's own buffer"):
    def asked(through: Address)(bench: Bench): Future[Vector[Either[String, Boolean]]] =
      import bench.system.dispatcher
      import upack.{Arr, Int64, Msg, Str}
      val client                             = bench.client(through)
      def plan(vehicle: String, moves: Msg*) =
        client.rpc.callAs[Boolean](
          "skeinFollowPlan",
          Seq(Int64(1), Arr(moves*), Str(vehicle))
        ).map(_.left.map:
          case RpcError.Refused(_, text) => text
          case other                     => fail(other.message))
      val none = Seq.empty[Msg]
      for
        answers <- Future.traverse(Vector(
          plan("Drone"),
          plan(""),
          plan("Nobody"),
          plan("Drone", Arr(Int64(1), Str("reset"), Arr(none*))),
          plan("Drone", Arr(Int64(1), Str("moveByVelocityZ"), Arr(Str("x")))),
          plan("Drone", Arr(Int64(2), Str("hover"), Arr(none*)), Arr(Int64(2), Str("hover"), Arr(none*))),
          plan("Drone", Arr(Int64(1), Str("hover"))),
          client.rpc.callAs[Boolean]("skeinFollowPlan", Seq(Str("Drone"))).map(_.left.map(_.message))
        ))(identity)
        _ <- client.close()
      yield answers
    val own             = on()(asked(Address("simulator", 41451)))
    val (answers, seen) = on(): bench =>
      import bench.system.dispatcher
      asked(Address("beside", 41452))(bench).map((_, bench.calls.map(_.method).toSet))
    assertEquals(answers, own)
    assertEquals(own.take(2), Vector(Right(true), Right(true)))
    assert(!seen("skeinFollowPlan"), seen.toString)

  test("all other bytes between client and simulator are identical with and without a buffer"):
    def heard(through: Address)(bench: Bench): Future[ByteString] =
      given ActorSystem = bench.system
      import upack.{Arr, Int32, Msg, Obj, Str}
      val none                                      = Seq.empty[Msg]
      def call(id: Int, name: String, params: Msg*) =
        ByteString(upack.write(Arr(Int32(0), Int32(id), Str(name), Arr(params*))))
      val picture = Obj(
        Str("camera_name")     -> Str("front_center"),
        Str("image_type")      -> Int32(0),
        Str("pixels_as_float") -> upack.False,
        Str("compress")        -> upack.False
      )
      val sent = Vector(
        call(1, "ping"),
        call(2, "getSettingsString"),
        call(3, "simGetImages", Arr(picture), Str("Drone")),
        call(4, "nosuch", Int32(1)),
        call(5, "enableApiControl", upack.True, Str("Drone")),
        ByteString(upack.write(Arr(Int32(2), Str("ping"), Arr(none*)))),
        call(6, "simSetCameraFov", Str("0"), Int32(90), Str("Drone")),
        call(7, "takeoff", Int32(1), Str("Drone")),
        ByteString(upack.write(Obj(Str("a") -> Int32(1)))),
        call(8, "hover", Str("Drone"))
      )
      // In uneven pieces, one after the other.
      val pieces = sent.reduce(_ ++ _).grouped(23).toVector
      Source(pieces)
        .concat(Source.future(bench.later(5000)(Future.successful(ByteString.empty))).filter(_.nonEmpty))
        .via(bench.direct(through))
        .runFold(ByteString.empty)(_ ++ _)
    // Answers come in any order, the image as soon as it is drawn.
    def messages(bytes: ByteString) =
      val framer = new Framer()
      framer.offer(bytes)
      Vector.unfold(framer.next()) {
        case Framed.Complete(frame) => Some((frame.toVector, framer.next()))
        case _                      => None
      }.sortBy(_(2))
    val (passed, own) =
      (messages(on()(heard(Address("beside", 41452)))), messages(on()(heard(Address("simulator", 41451)))))
    assertEquals(own.map(_(2)), Vector.tabulate(8)(index => (index + 1).toByte))
    assertEquals(passed.map(_.size), own.map(_.size))
    for (one, other) <- passed.zip(own) do
      val apart = one.indices.filter(index => one(index) != other(index))
      assert(apart.isEmpty, s"answer ${one(2)}: bytes ${apart.take(5)} of ${one.size}, ${apart.size} in all")
