package skein.rpc

import java.util.concurrent.LinkedBlockingQueue
import java.util.concurrent.TimeUnit.SECONDS
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep}
import org.apache.pekko.stream.testkit.scaladsl.{TestSink, TestSource}
import org.apache.pekko.util.ByteString
import scala.concurrent.{Future, Promise}
import skein.link.Places
import upack.{Arr, Binary, Int32, Msg, Null, Str}

/** A server's treatment of connections that demand too much memory or time, in manual time. */
class ServerLimitsSuite extends munit.FunSuite:

  /** A server without sockets: connections share memory and places. */
  private final class Rig(limits: ServerLimits)(using val system: ActorSystem):
    val time           = ManualTime.of(system)
    val holdings       = Holdings(limits.heldBytesPerConnection, limits.heldBytesInCommon)
    val turns          = Holdings(limits.inFlightAssured, limits.inFlightInCommon)
    val counters       = ServerCounters(holdings)
    val guests         = java.util.concurrent.ConcurrentLinkedQueue[Places.Guest]()
    private val places = new Places(limits.connections, limits.silence):
      override def entered(connection: Long, guest: Places.Guest): Unit =
        val _ = guests.add(guest)
    val events           = LinkedBlockingQueue[ServerEvent]()
    val never            = Promise[Either[String, Msg]]()
    private var accepted = 0L

    private def handler(request: RpcRequest): Future[Either[String, Msg]] =
      request.method match
        case "never" => never.future
        case "image" => Future.successful(Right(Binary(new Array[Byte](200_000))))
        case _       => Future.successful(Right(Int32(1)))

    final class Connection(takesReplies: Boolean = true):
      accepted += 1
      private val number = accepted
      private val stage  =
        ServerConnection(
          number,
          limits,
          handler,
          counters,
          holdings,
          turns,
          places,
          events.put
        )
      val (requests, replies) =
        TestSource[ByteString]().via(Flow.fromGraph(stage)).toMat(TestSink[ByteString]())(Keep.both).run()

      if takesReplies then
        val _ = replies.request(1000)

      def send(bytes: ByteString): Unit =
        val _ = requests.sendNext(bytes)

      def ask(method: String): Unit =
        send(ByteString(Wire.pack(Arr(Int32(0), Int32(1), Str(method), Arr()))))

      /** Sends a request and awaits its answer, by which everything sent before has been handled. */
      def ping(): Unit =
        ask("ping")
        val _ = replies.expectNext()

      def expectClosed(why: String): Unit =
        assertEquals(Rig.this.closed(), ServerEvent.Closed(number, Some(why)))

    def closed(): ServerEvent =
      Option(events.poll(5, SECONDS)).getOrElse(throw AssertionError("nothing was closed"))

    /** Lets time pass until a connection has been closed. */
    def passUntilClosed(): Unit = until:
      time.advance(ServerLimits.Watch)
      !events.isEmpty

    def until(holds: => Boolean): Unit =
      val patience = System.nanoTime() + 5_000_000_000L
      while !holds do
        assert(System.nanoTime() < patience, "it never came to hold")
        Thread.onSpinWait()

  private def rig(name: String, limits: ServerLimits)(body: Rig => Unit): Unit = test(name):
    given system: ActorSystem = ManualTime.system("server-limits")
    try body(Rig(limits))
    finally
      val _ = system.terminate()

  /** The first `sent` bytes of a request that is `size` bytes long. */
  private def begun(size: Int, sent: Int): ByteString =
    ByteString(Wire.pack(Arr(Int32(0), Int32(1), Str("f"), Arr(Binary(new Array[Byte](size)))))).take(sent)

  private val small = ServerLimits(heldBytesPerConnection = 10_000, heldBytesInCommon = 50_000)

  rig("unfinished messages share one limit, and a connection that exceeds it is closed", small): r =>
    val greedy = Seq.fill(2)(r.Connection())
    greedy.foreach(_.send(begun(60_000, 30_000)))
    r.until(r.holdings.bytes == 60_000)
    val third = r.Connection()
    third.send(begun(60_000, 30_000))
    third.expectClosed(
      "30000 bytes of it are held, and no more than 50000 in all beyond 10000 for each connection"
    )
    val honest = r.Connection()
    honest.ping()
    assertEquals(r.counters.snapshot.overHeld, 1L)
    greedy.head.requests.sendError(RuntimeException("gone"))
    val _ = r.closed()
    r.until(r.holdings.bytes == 30_000)
    assert(r.holdings.mostBytes <= small.heldBytes)

  private val three = ServerLimits(heldBytesPerConnection = 10_000, heldBytesInCommon = 120_000)

  private def large(id: Int): ByteString =
    ByteString(Wire.pack(Arr(Int32(0), Int32(id), Str("never"), Arr(Binary(new Array[Byte](40_000))))))

  private def never(id: Int): ByteString =
    ByteString(Wire.pack(Arr(Int32(0), Int32(id), Str("never"), Arr())))

  /** A connection whose large request is in progress, and that holds nothing else. */
  private def waits(r: Rig): r.Connection =
    val before     = r.holdings.bytes
    val connection = r.Connection()
    connection.send(large(1))
    r.until(r.holdings.bytes == before + 40_685)
    connection

  private def replies(bytes: Seq[ByteString]): Seq[RpcMessage] =
    Wire.framed(Framer(), bytes).collect { case Framed.Complete(frame) => RpcMessage.fromServer(frame) }

  rig("a request holds memory until it is answered, and one too large for the rest is refused", three): r =>
    val waiting = Seq.fill(2)(waits(r))
    val third   = r.Connection()
    third.send(large(300))
    val text =
      "this request takes 40687 bytes of the server's memory, and no " +
        "more than 120000 in all beyond 10000 for each connection"
    assertEquals(replies(Seq(third.replies.expectNext())), Seq(RpcMessage.Reply(300, Str(text), Null)))
    third.ping()
    assertEquals(r.counters.snapshot.lacking, 1L)
    r.never.success(Right(Null))
    for c <- waiting do
      val _ = c.replies.expectNext()
      c.ping()
    r.until(r.holdings.bytes == 0)

  rig("a pipeline of large requests is held back, and all of them are answered", three): r =>
    val honest = r.Connection()
    honest.send(large(1) ++ large(2))
    r.until(r.counters.snapshot.requests == 1 && r.holdings.bytes > 155_000) // the second is held back
    r.time.advance(ServerLimits.Watch)
    assertEquals(r.counters.snapshot.requests, 1L)
    r.never.success(Right(Null))
    for id <- 3 to 8 do honest.send(large(id))
    var answers = Seq.empty[ByteString]
    while replies(answers).size < 8 do answers :+= honest.replies.expectNext()
    assertEquals(replies(answers), (1 to 8).map(id => RpcMessage.Reply(id, Null, Null): RpcMessage))
    assertEquals((r.counters.snapshot.lacking, r.events.size), (0L, 0))
    assert(r.holdings.mostBytes <= three.heldBytes)

  rig("a request that waits behind endless ones is refused after the time limit of a message", three): r =>
    val honest = waits(r)
    val _      = waits(r)
    honest.send(large(2))
    r.until:
      r.time.advance(ServerLimits.Watch)
      r.counters.snapshot.lacking == 1
    assertEquals(replies(Seq(honest.replies.expectNext())).map(_.productPrefix), Seq("Reply"))
    assertEquals(r.events.size, 0)

  rig("a reply too large for the memory left becomes an error and takes none of it", three): r =>
    val image = r.Connection()
    image.ask("image")
    val text =
      "the reply takes 200009 bytes of the server's memory, and no more " +
        "than 120000 in all beyond 10000 for each connection"
    assertEquals(replies(Seq(image.replies.expectNext())), Seq(RpcMessage.Reply(1, Str(text), Null)))
    image.ping()
    assertEquals((r.counters.snapshot.lacking, r.counters.snapshot.refused), (1L, 1L))
    assert(r.holdings.mostBytes <= three.heldBytes)

  private val six = ServerLimits(inFlightAssured = 2, inFlightInCommon = 4)

  rig(
    "a client with many endless requests leaves others their share, and all of its own are taken",
    six
  ): r =>
    val greedy = r.Connection()
    greedy.send((1 to 20).map(never).reduce(_ ++ _))
    r.until(r.counters.snapshot.requests == 6)
    val honest = r.Connection()
    honest.send(never(1))
    honest.ping()
    honest.send(never(2) ++ never(3))
    r.until(r.counters.snapshot.requests == 9)
    greedy.requests.sendError(RuntimeException("gone"))
    assertEquals(r.closed(), ServerEvent.Closed(1, Some("gone")))
    r.until(r.turns.bytes == 2)
    r.until:
      r.time.advance(ServerLimits.Watch)
      r.counters.snapshot.requests == 10
    r.never.success(Right(Null))
    r.until(r.counters.snapshot.answered == 4)
    r.until(r.turns.bytes == 0)

  rig("requests beyond the limit are taken as earlier ones are answered", six): r =>
    val greedy = r.Connection()
    greedy.send((1 to 20).map(never).reduce(_ ++ _))
    r.until(r.counters.snapshot.requests == 6)
    r.never.success(Right(Null))
    var answers = Seq.empty[ByteString]
    while replies(answers).size < 20 do answers :+= greedy.replies.expectNext()
    assertEquals(
      replies(answers).toSet,
      (1 to 20).map(id => RpcMessage.Reply(id, Null, Null): RpcMessage).toSet
    )
    assertEquals(r.turns.mostBytes, 6L)

  rig("a message that takes too long closes its connection and gives back its memory", ServerLimits()): r =>
    val slow = r.Connection()
    slow.ping()
    slow.send(begun(1000, 500))
    r.until(r.holdings.bytes == 500)
    r.passUntilClosed()
    slow.expectClosed("a message under way for more than 10 s")
    assertEquals((r.counters.snapshot.tooSlow, r.holdings.bytes), (1L, 0L))

  rig("a peer that takes no replies is closed", ServerLimits()): r =>
    val deaf = r.Connection(takesReplies = false)
    deaf.ask("ping")
    deaf.replies.requestNext()
    r.until(r.counters.snapshot.answered == 1)
    r.passUntilClosed()
    deaf.expectClosed("replies not taken for more than 30 s")

  rig("a connection whose place is needed is closed", ServerLimits()): r =>
    val guest = r.Connection()
    guest.ping()
    r.guests.forEach(_.leave())
    guest.expectClosed("its place was needed")
    assertEquals(r.counters.snapshot.idle, 1L)

  rig("a limited number of values that are no messages is tolerated", ServerLimits(strays = 3)): r =>
    val c     = r.Connection()
    val stray = ByteString(0x05)
    c.ping()
    c.send(stray ++ stray ++ stray)
    c.ping()
    c.send(stray ++ stray ++ stray ++ stray)
    for _ <- 1 to 7 do assert(r.closed().isInstanceOf[ServerEvent.Ignored])
    c.expectClosed("more than 3 values in a row that are no messages")
