package skein.rpc

import java.util.concurrent.LinkedBlockingQueue
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep}
import org.apache.pekko.stream.testkit.scaladsl.{TestSink, TestSource}
import org.apache.pekko.util.ByteString
import scala.concurrent.{Future, Promise}
import skein.link.Places
import upack.{Arr, Binary, Int32, Msg, Null, Str}

class ServerConnectionSuite extends munit.FunSuite:
  private given system: ActorSystem = ActorSystem("rpc-server")

  override def afterAll(): Unit =
    val _ = system.terminate()

  /** One served connection whose handler answers at the test's command. */
  private final class Rig(limits: ServerLimits = ServerLimits()):
    val asked    = LinkedBlockingQueue[(RpcRequest, Promise[Either[String, Msg]])]()
    val events   = LinkedBlockingQueue[ServerEvent]()
    val holdings = Holdings(limits.heldBytesPerConnection, limits.heldBytesInCommon)
    val turns    = Holdings(limits.inFlightAssured, limits.inFlightInCommon)
    val counters = ServerCounters(holdings)
    val places   = Places(limits.connections, limits.silence)

    private def handler(request: RpcRequest): Future[Either[String, Msg]] = request.method match
      case "now"   => Future.successful(Right(Int32(1)))
      case "throw" => throw IllegalArgumentException("bad")
      case _       =>
        val answer = Promise[Either[String, Msg]]()
        asked.put(request -> answer)
        answer.future

    private val stage =
      ServerConnection(
        1,
        limits,
        handler,
        counters,
        holdings,
        turns,
        places,
        events.put(_)
      )
    val (requests, replies) =
      TestSource[ByteString]().via(Flow.fromGraph(stage)).toMat(TestSink[ByteString]())(Keep.both).run()
    private val framer   = Framer()
    private val answered = scala.collection.mutable.Queue.empty[RpcMessage]

    /** The next request that waits for the test's answer. */
    def next(): (RpcRequest, Promise[Either[String, Msg]]) = taken(asked)
    def event(): ServerEvent                               = taken(events)

    private def taken[A](queue: LinkedBlockingQueue[A]): A =
      Option(queue.poll(5, java.util.concurrent.TimeUnit.SECONDS)).getOrElse(fail("nothing came"))

    def ask(id: Int, method: String): Unit = send(Arr(Int32(0), Int32(id), Str(method), Arr()))
    def send(msg: Msg): Unit               = send(ByteString(Wire.pack(msg)))
    def send(bytes: ByteString): Unit      =
      val _ = requests.sendNext(bytes)
    def reply(): RpcMessage =
      while answered.isEmpty do
        for case Framed.Complete(frame) <- Wire.framed(framer, Seq(replies.requestNext())) do
          answered.enqueue(RpcMessage.fromServer(frame))
      answered.dequeue()

  test("replies leave in the order of completion"):
    val r = Rig()
    r.ask(1, "slow")
    r.ask(2, "fast")
    val slow = r.next()
    val fast = r.next()
    assertEquals((slow._1.connection, fast._1.connection), (1L, 1L))
    fast._2.success(Right(Str("fast")))
    assertEquals(r.reply(), RpcMessage.Reply(2, Null, Str("fast")))
    slow._2.success(Left("no"))
    assertEquals(r.reply(), RpcMessage.Reply(1, Str("no"), Null))

  test("the error of a handler that throws or fails has rpclib's text, and the connection survives"):
    val r     = Rig()
    val words =
      "rpclib: function 'throw' (called with 0 arg(s)) threw an exception. " +
        "The exception contained this information: bad."
    r.ask(1, "throw")
    assertEquals(r.reply(), RpcMessage.Reply(1, Str(words), Null))
    r.ask(2, "later")
    r.next()._2.failure(IllegalArgumentException("bad"))
    assertEquals(r.reply(), RpcMessage.Reply(2, Str(words.replace("'throw'", "'later'")), Null))

  test("a notification runs and is not answered"):
    val r = Rig()
    r.send(Arr(Int32(2), Str("note"), Arr(Int32(5))))
    val (request, answer) = r.next()
    assertEquals(request, RpcRequest(1, "note", Vector(Int32(5)), notification = true))
    answer.success(Right(Null))
    r.ask(3, "now")
    assertEquals(r.reply(), RpcMessage.Reply(3, Null, Int32(1)))

  test("values that are not messages are counted and the connection survives"):
    val r = Rig()
    r.ask(0, "now")
    assertEquals(r.reply(), RpcMessage.Reply(0, Null, Int32(1)))
    r.send(Arr(Int32(0), Int32(1)))
    r.send(upack.Obj(Str("a") -> Null))
    r.send(Int32(7))
    r.ask(1, "now")
    assertEquals(r.reply(), RpcMessage.Reply(1, Null, Int32(1)))
    assertEquals(
      Seq.fill(3)(r.event()),
      Seq("an array of 2", "a map", "an integer").map(ServerEvent.Ignored(1, _))
    )

  for (bytes, came) <- Seq(
      ByteString("GET / HTTP/1.1\r\n")     -> "an HTTP request (GET)",
      ByteString("P")                      -> "a first byte of 0x50",
      ByteString("OPTIONS / HTTP/1.1\r\n") -> "an HTTP request (OPTIONS)",
      ByteString(22, 3, 1, 2, 0)           -> "a greeting of TLS",
      ByteString(0x05)                     -> "a first byte of 0x05",
      ByteString(Wire.pack(upack.Obj()))   -> "a first byte of 0x80",
      ByteString(0x93, 5, 6, 7)            -> "",
      ByteString(0x94, 1, 2, 0xc0, 0xc0)   -> ""
    )
  do
    test(s"no request is obeyed on a connection that begins with ${bytes.map(b => f"$b%02x").mkString(" ")}"):
      val r = Rig()
      r.send(bytes ++ ByteString(Wire.pack(Arr(Int32(0), Int32(1), Str("slow"), Arr()))))
      val _ = r.replies.ensureSubscription().expectComplete()
      r.event() match
        case ServerEvent.Closed(1, Some(why)) if came.nonEmpty =>
          assertEquals(why, s"expected a message of MessagePack-RPC, got $came")
        case ServerEvent.Closed(1, Some(_)) if came.isEmpty => ()
        case other                                          => fail(s"$other")
      assert(r.asked.isEmpty)
      assertEquals(r.counters.snapshot.malformed, 1L)

  test("before the first request no other message is accepted"):
    val r = Rig()
    r.send(ByteString(0xdc, 0, 2, 1, 2) ++ ByteString(Wire.pack(Arr(Int32(0), Int32(1), Str("slow"), Arr()))))
    val _ = r.replies.ensureSubscription().expectComplete()
    assertEquals(r.event(), ServerEvent.Ignored(1, "an array of 2"))
    assertEquals(
      r.event(),
      ServerEvent.Closed(1, Some("expected a message of MessagePack-RPC first, got an array of 2"))
    )

  for (what, bytes, reason) <- Seq(
      ("byte 0xc1", ByteString(0xc1), "byte 0xc1, which MessagePack never uses"),
      (
        "an id that is a string",
        ByteString(Wire.pack(Arr(Int32(0), Str("1"), Str("f"), Arr()))),
        "an id that is a string"
      ),
      ("a negative id", ByteString(Wire.pack(Arr(Int32(0), Int32(-1), Str("f"), Arr()))), "a negative id: -1")
    )
  do
    test(s"$what closes the connection with the reason"):
      val r = Rig()
      r.ask(1, "never answered")
      val _ = r.next()
      r.send(bytes)
      val _ = r.replies.ensureSubscription().expectComplete()
      r.requests.expectCancellation()
      assertEquals(r.event(), ServerEvent.Closed(1, Some(reason)))

  test("requests beyond the limit wait until one is answered"):
    val r = Rig(ServerLimits(inFlightPerConnection = 2))
    val _ = r.send((1 to 5).map(id =>
      ByteString(Wire.pack(Arr(Int32(0), Int32(id), Str("slow"), Arr())))
    ).reduce(_ ++ _))
    val first = r.next()
    val _     = r.next()
    assertEquals(r.counters.snapshot.requests, 2L)
    first._2.success(Right(Null))
    assertEquals(r.reply(), RpcMessage.Reply(1, Null, Null))
    val _ = r.next()
    assertEquals(r.counters.snapshot.requests, 3L)

  test("nothing more is read from a peer that takes no replies"):
    val r       = Rig(ServerLimits(unsentBytesPerConnection = 1000))
    val request = ByteString(Wire.pack(Arr(Int32(0), Int32(1), Str("slow"), Arr())))
    r.send(request ++ request ++ request)
    val asked = Seq.fill(3)(r.next())
    for (_, answer) <- asked do answer.success(Right(Binary(new Array[Byte](600))))
    r.send(request)
    assertEquals(r.counters.snapshot.requests, 3L)
    assertEquals(r.reply().productPrefix, "Reply") // the replies leave, the fourth request is read
    val _ = r.next()
    assertEquals(r.counters.snapshot.requests, 4L)

  test("the requests of a peer that has finished sending are still answered"):
    val r = Rig()
    r.ask(1, "slow")
    r.requests.sendComplete()
    assertEquals(r.event(), ServerEvent.Finished(1))
    r.next()._2.success(Right(Int32(9)))
    assertEquals(r.reply(), RpcMessage.Reply(1, Null, Int32(9)))
    val _ = r.replies.expectComplete()
    assertEquals(r.event(), ServerEvent.Closed(1, None))

  test("a stream that ends within a message is closed for that reason"):
    val r = Rig()
    r.send(ByteString(0x94, 0x00))
    r.requests.sendComplete()
    val _ = r.replies.ensureSubscription().expectComplete()
    assertEquals(r.event(), ServerEvent.Finished(1))
    assertEquals(r.event(), ServerEvent.Closed(1, Some("the peer stopped in the middle of a message")))
