package skein.rpc

import java.util.concurrent.LinkedBlockingQueue
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.util.ByteString
import scala.concurrent.Future
import skein.link.Address
import skein.units.*
import upack.{Int32, Msg, Str}

class RpcClientSuite extends munit.FunSuite:
  private given system: ActorSystem = ManualTime.system("rpc-client")
  import system.dispatcher

  override def afterAll(): Unit =
    val _ = system.terminate()

  private val time    = ManualTime.of(system)
  private val address = Address("sim", 41451)

  private final class Rig(connections: Int = 1):
    val transport = ScriptedTransport()
    val events    = LinkedBlockingQueue[RpcEvent]()
    val settings  = RpcSettings(
      controlConnections = connections,
      backOff = BackOff(Span.ofMillis(50), Span.ofMillis(50), 0)
    )
    val client = RpcClient(transport, address, time, settings, seed = 1, observer = events.put(_))
    def call(method: String, options: CallOptions = CallOptions()): Future[Either[RpcError, Msg]] =
      client.call(method, Seq.empty, options)

    def await[E <: RpcEvent: reflect.ClassTag](): Unit =
      Iterator
        .continually(events.poll(5, java.util.concurrent.TimeUnit.SECONDS))
        .find:
          case _: E => true
          case null => fail("no such event came")
          case _    => false
        .foreach(_ => ())

  private def rig(name: String, connections: Int = 1)(body: Rig => Future[Unit]): Unit =
    test(name):
      val r = Rig(connections)
      body(r).transformWith(result => r.client.close().transform(_ => result))

  rig("answers out of order, or in one segment, reach their own calls"): r =>
    val calls  = Seq("a", "b", "c").map(r.call(_))
    val peer   = r.transport.peer()
    val ids    = Seq.fill(3)(peer.request()).map(request => request.method -> request.id).toMap
    val writer = MessageWriter()
    for (method, n) <- Seq("c" -> 3, "a" -> 1, "b" -> 2) do writer.reply(ids(method), Right(Int32(n)))
    peer.send(writer.take())
    Future.sequence(calls).map(assertEquals(_, Seq(1, 2, 3).map(n => Right(Int32(n)))))

  rig("a refusal contains the peer's text"): r =>
    val call = r.call("takeoff")
    val peer = r.transport.peer()
    peer.refuse(peer.request().id, "std::bad_cast")
    call.map(assertEquals(_, Left(RpcError.Refused("takeoff", "std::bad_cast"))))

  rig("a late answer is dropped and counted, and later calls get their own answers"): r =>
    val late = r.call("late", CallOptions(timeout = Span.ofMillis(5)))
    val peer = r.transport.peer()
    val id   = peer.request().id
    time.advance(Span.ofMillis(5))
    for
      first <- late
      _    = assertEquals(first, Left(RpcError.Timeout("late", Span.ofMillis(5))))
      _    = peer.answer(id, Str("too late"))
      next = r.call("next")
      _    = peer.answer(peer.request().id, Str("in time"))
      second <- next
    yield
      assertEquals(second, Right(Str("in time")))
      assertEquals(r.client.stats.late, 1L)
      assertEquals(r.client.stats.timedOut, 1L)
      assertEquals(r.client.stats.pending, 0L)

  rig("after the loss of its connection a call may have run, and the client connects again by itself"): r =>
    val lost = r.call("move")
    val peer = r.transport.peer()
    val _    = peer.request()
    peer.fail("reset by peer")
    for
      first <- lost
      _     = r.await[RpcEvent.Reconnecting]()
      _     = time.advance(Span.ofMillis(50))
      _     = assertEquals(first, Left(RpcError.ConnectionLost(address, mayHaveRun = true, "reset by peer")))
      next  = r.call("move again")
      again = r.transport.peer()
      _     = again.answer(again.request().id, Int32(1))
      second <- next
    yield assertEquals(second, Right(Int32(1)))

  rig("an idempotent call survives the loss of its connection"): r =>
    val call  = r.call("read", CallOptions(idempotent = true))
    val first = r.transport.peer()
    val _     = first.request()
    first.close()
    r.await[RpcEvent.Reconnecting]()
    time.advance(Span.ofMillis(50))
    val second = r.transport.peer()
    second.answer(second.request().id, Int32(7))
    call.map: result =>
      assertEquals(result, Right(Int32(7)))
      assertEquals(r.client.stats.sentAgain, 1L)

  rig("malformed bytes close only their own connection, with the reason", connections = 2): r =>
    val calls          = Seq(r.call("a", CallOptions(key = Some(0))), r.call("b", CallOptions(key = Some(1))))
    val peers          = Seq.fill(2)(r.transport.peer()).map(peer => peer -> peer.request())
    val Seq(bad, good) = peers.sortBy(_._2.method): @unchecked
    bad._1.send(ByteString(0xc1))
    bad._1.expectClosed()
    good._1.answer(good._2.id, Int32(2))
    Future
      .sequence(calls)
      .map:
        assertEquals(
          _,
          Seq(Left(RpcError.Malformed("a", "byte 0xc1, which MessagePack never uses")), Right(Int32(2)))
        )

  rig("values that are no replies are counted, and the connection stays open"): r =>
    val call = r.call("a")
    val peer = r.transport.peer()
    val id   = peer.request().id
    peer.send(ByteString(0x80, 0x05, 0x93, 0x02, 0xa1, 'x', 0x90))
    peer.answer(id + 1)
    peer.answer(id, Int32(1))
    call.map: result =>
      assertEquals(result, Right(Int32(1)))
      assertEquals(r.client.stats.ignored, 3L)
      assertEquals(r.client.stats.unexpected, 1L)

  test("without a server a call fails with the address and the reason"):
    val transport = ScriptedTransport()
    transport.refuse = Some(RuntimeException("connection refused"))
    val client = RpcClient(transport, address, time)
    for
      result <- client.call("ping", Seq.empty)
      _      <- client.close()
    yield assertEquals(result, Left(RpcError.Unreachable(address, "connection refused")))

  rig("calls with equal keys share a connection, in order, and others use other ones", connections = 3): r =>
    val keyed = (1 to 4).map(i => r.call(s"$i", CallOptions(key = Some(7))))
    val other = (5 to 6).map(i => r.call(s"$i", CallOptions(key = Some(3 + i))))
    val peers = Seq.fill(3)(r.transport.peer())
    val seen  = peers.map: peer =>
      val first    = peer.request()
      val requests = first +: Seq.fill(if first.method == "1" then 3 else 0)(peer.request())
      requests.foreach(request => peer.answer(request.id))
      requests.map(_.method)
    for _ <- Future.sequence(keyed ++ other)
    yield assertEquals(seen.toSet, Set(Seq("1", "2", "3", "4"), Seq("5"), Seq("6")))

  rig("a result of another type is reported as malformed"): r =>
    val call = r.client.callAs[Double]("x", Seq.empty)
    val peer = r.transport.peer()
    peer.answer(peer.request().id, Str("no number"))
    call.map:
      case Left(RpcError.Malformed("x", _)) => ()
      case other                            => fail(s"$other")

  rig("closing ends current and later calls, and closes the connections"): r =>
    val call = r.call("a")
    val peer = r.transport.peer()
    val _    = peer.request()
    for
      _      <- r.client.close()
      first  <- call
      second <- r.call("b")
    yield
      peer.expectClosed()
      assertEquals(first, Left(RpcError.Cancelled("a")))
      assertEquals(second, Left(RpcError.Cancelled("b")))
      assertEquals(r.client.stats.pending, 0L)
