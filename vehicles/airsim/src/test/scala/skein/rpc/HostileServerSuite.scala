package skein.rpc

import java.util.concurrent.LinkedBlockingQueue
import java.util.concurrent.TimeUnit.SECONDS
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, Future}
import skein.airsim.{AirSimClient, Multirotor}
import skein.link.Address
import skein.units.*
import upack.{Arr, Binary, Float32, Float64, Int32, Int64, Msg, Null, Obj, Str}

/** A client with a hostile peer: its memory stays bounded, and each call ends with a readable reason. */
class HostileServerSuite extends munit.FunSuite:
  private given system: ActorSystem = ManualTime.system("hostile-server")

  override def afterAll(): Unit =
    val _ = system.terminate()

  private val time = ManualTime.of(system)

  private final class Rig(settings: RpcSettings):
    val transport      = ScriptedTransport()
    val events         = LinkedBlockingQueue[RpcEvent]()
    private val quick  = settings.copy(backOff = BackOff(Span.ofMillis(50), Span.ofMillis(50), 0))
    val client         = RpcClient(transport, Address("sim", 41451), time, quick, 1, events.put)
    private var called = Option.empty[Future[Either[RpcError, Msg]]]

    /** Makes a call; returns the peer with the call's id. */
    def call(): (Peer, Long) =
      called = Some(client.call("read", Seq.empty))
      val peer = transport.peer()
      peer -> peer.request().id

    def outcome(): Either[RpcError, Msg] = Await.result(called.get, 5.seconds)

    def closed(): String =
      val reason = Iterator
        .continually(Option(events.poll(5, SECONDS)).getOrElse(fail("the connection was not closed")))
        .collectFirst { case RpcEvent.Disconnected(_, _, reason) => reason }
      reason.get

  private def rig(name: String, settings: RpcSettings = RpcSettings(controlConnections = 1))(
      body: Rig => Unit
  ): Unit = test(name):
    val r = Rig(settings)
    try body(r)
    finally Await.result(r.client.close(), 5.seconds): Unit

  private def malformed(reason: String) = Left(RpcError.Malformed("read", reason))

  rig("a map of 40,000 keys with equal hashes in an answer is refused at its header"): r =>
    val (peer, id) = r.call()
    peer.send(ByteString(0x94, 0x01, id.toInt, 0xc0, 0xde, 0x9c, 0x40))
    assertEquals(r.outcome(), malformed("a map of 40000 keys; at most 128 are accepted"))

  rig("a flood of answers to no call ends the connection"): r =>
    val (peer, _) = r.call()
    val writer    = MessageWriter()
    for id <- 1 to 5000 do writer.reply(1_000_000L + id, Right(Null))
    peer.send(writer.take())
    assertEquals(r.outcome(), malformed("more than 1000 values in a row that answer no call"))
    assertEquals(r.client.stats.unexpected, 1001L)

  rig("a flood of notifications ends the connection"): r =>
    val (peer, _) = r.call()
    peer.send(ByteString.fromArray(Array.fill(5000)(Wire.notification("look", Int32(1))).flatten))
    assertEquals(r.closed(), "more than 1000 values in a row that answer no call")
    assertEquals(r.client.stats.ignored, 1001L)

  rig("a limited number of other messages between answers is tolerated"): r =>
    val writer     = MessageWriter()
    val (peer, id) = r.call()
    val others     = ByteString.fromArray(Array.fill(900)(Wire.notification("look")).flatten)
    writer.reply(id, Right(Int32(1)))
    peer.send(others ++ writer.take() ++ others)
    assertEquals(r.outcome(), Right(Int32(1)))
    val next = r.client.call("read", Seq.empty)
    peer.answer(peer.request().id, Int32(2))
    assertEquals(Await.result(next, 5.seconds), Right(Int32(2)))

  rig("a message that never ends is given up after a minute"): r =>
    val (peer, _) = r.call()
    peer.send(ByteString(0x94, 0x01))
    time.advance(Span.ofSeconds(5))
    assertEquals(r.outcome(), Left(RpcError.Timeout("read", Span.ofSeconds(5))))
    val patience = System.nanoTime() + 5_000_000_000L
    while r.client.stats.disconnected == 0 do
      time.advance(Span.ofSeconds(1))
      assert(System.nanoTime() < patience, "the connection was not closed")
    assertEquals(r.closed(), "a message under way for more than 60 s")

  rig("unfinished messages share one limit", RpcSettings(controlConnections = 1, openBytes = 1 << 20)): r =>
    val (peer, id) = r.call()
    val answer = ByteString(Wire.pack(Arr(Int32(1), Int32(id.toInt), Null, Binary(new Array[Byte](3 << 20)))))
    peer.send(answer.take((2 << 20) + 1))
    assertEquals(
      r.outcome(),
      malformed("2097153 bytes of an unfinished message are held, and no more than 1048576 in all")
    )

  rig("an error text of any length is shortened"): r =>
    val (peer, id) = r.call()
    peer.refuse(id, "no" * 1_000_000)
    r.outcome() match
      case Left(RpcError.Refused("read", text)) => assertEquals(text, "no" * 2000 + "… (2000000 characters)")
      case other                                => fail(s"$other")

  rig("if a peer never answers, a window of calls times out and the others are refused"): r =>
    val calls = Seq.fill(2000)(r.client.call("read", Seq.empty, CallOptions(timeout = Span.ofSeconds(1))))
    val peer  = r.transport.peer()
    val _     = peer.request()
    time.advance(Span.ofSeconds(1))
    val errors = calls.map(Await.result(_, 5.seconds).left.toOption.get)
    assert(errors.forall(e => e.isInstanceOf[RpcError.Timeout] || e.isInstanceOf[RpcError.Overloaded]))
    assertEquals(r.client.stats.pending, 0L)

  private final case class Inner(x: Double) derives skein.airsim.wire.Fields
  private final case class Outer(name: String, inner: Inner, more: Seq[Inner])
      derives skein.airsim.wire.Fields

  private def asked(r: Rig, answer: Msg): String =
    val outcome = r.client.callAs[Outer]("read", Seq.empty)
    val peer    = r.transport.peer()
    peer.answer(peer.request().id, answer)
    Await.result(outcome, 5.seconds).fold(_.message, value => fail(s"$value"))

  private def one(x: Msg)                       = Obj(Str("x") -> x)
  private def outer(inner: Msg, more: Msg): Msg =
    Obj(Str("name") -> Str("a"), Str("inner") -> inner, Str("more") -> more)

  for (where, answer, reason) <- Seq(
      ("in the place of everything", Null, "expected a value, got nil"),
      ("in a structure", outer(Null, Arr()), "expected a value in inner, got nil"),
      (
        "in a list in a structure",
        outer(one(Float64(1)), Arr(one(Float64(1)), Null)),
        "expected a value in more.1, got nil"
      ),
      ("in the place of a number", outer(one(Null), Arr()), "expected a value in inner.x, got nil")
    )
  do
    rig(s"an answer with nil $where is malformed, and is reported in one line"): r =>
      val message = asked(r, answer)
      assertEquals(message, s"read: malformed answer: $reason")

  for (where, answer, reason) <- Seq(
      ("in the place of everything", Int32(1), "expected dictionary got int32"),
      ("in a structure", outer(Str("far"), Arr()), "expected dictionary got string in inner"),
      (
        "in the place of a number",
        outer(one(Str("far")), Arr()),
        "expected a number, got a string in inner.x"
      )
    )
  do
    rig(s"a value of another type $where is reported without class names"): r =>
      assertEquals(asked(r, answer), s"read: malformed answer: $reason")

  rig("a vehicle state with NaN is a malformed answer"): r =>
    val state                              = Multirotor(AirSimClient(r.client), "A").status()
    val peer                               = r.transport.peer()
    def all(number: Float, names: String*) =
      val numbers = Obj()
      for name <- names do numbers.value(Str(name)) = Float32(number)
      numbers
    def vector     = all(Float.NaN, "x_val", "y_val", "z_val")
    def turn       = all(0, "w_val", "x_val", "y_val", "z_val")
    val kinematics = Obj(
      Str("position")             -> vector,
      Str("orientation")          -> turn,
      Str("linear_velocity")      -> vector,
      Str("angular_velocity")     -> vector,
      Str("linear_acceleration")  -> vector,
      Str("angular_acceleration") -> vector
    )
    peer.answer(
      peer.request().id,
      Obj(
        Str("kinematics_estimated") -> kinematics,
        Str("timestamp")            -> Int64(1),
        Str("landed_state")         -> Int32(1)
      )
    )
    assertEquals(
      Await.result(state, 5.seconds).left.map(_.message),
      Left("getMultirotorState: malformed answer: expected finite numbers in kinematics_estimated")
    )
