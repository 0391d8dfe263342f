package skein.rpc

import java.io.IOException
import java.net.{InetAddress, ServerSocket, Socket}
import java.util.concurrent.{LinkedBlockingQueue, TimeUnit}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, Future}
import scala.util.Random
import skein.link.{Address, FirstBytes, TcpTransport}
import skein.units.*
import upack.{Int32, Msg, Null}

/** Mutated byte sequences against a live server and a live client, over loopback sockets. */
object PairFuzz:

  /** @param sequences number of sequences, each on a connection of its own
    * @param closedWithReason number of connections that the server closed with a logged reason, as expected
    *   for each
    * @param healthy number of correct answers to a well-behaved client meanwhile
    */
  final case class ServerFigures(sequences: Int, closedWithReason: Long, replies: Long, healthy: Long)

  /** Checks that every connection ends with the correct reason, and that the other client is unaffected. */
  def server(sequences: Int, seed: Long)(using system: ActorSystem): ServerFigures =
    val transport = TcpTransport()
    val closings  = LinkedBlockingQueue[ServerEvent.Closed]()
    val limits    = ServerLimits(frame = frameLimits)
    val server    = Await.result(
      RpcServer.bind(
        transport,
        loopback(0),
        limits,
        observer =
          case closed: ServerEvent.Closed => closings.put(closed)
          case _                          => ()
      )(echo),
      10.seconds
    )
    val client = RpcClient(transport, server.address, Clock.system, RpcSettings(controlConnections = 1))
    var healthy, replies = 0L
    for i <- 0 until sequences do
      val clue   = s"seed ${seed + i}"
      val random = Random(seed + i)
      val bytes  = Mutation.of(random, Mutation.request)
      val ping   = client.call("echo", Seq(Int32(i)))
      val got    = exchange(server.address.port, bytes)
      val closed =
        Option(closings.poll(10, TimeUnit.SECONDS)).getOrElse(throw AssertionError(s"left open, $clue"))
      val wanted = expectedReason(bytes)
      check(closed.reason == wanted, s"closed with ${closed.reason}, expected $wanted, $clue")
      val answers = Wire.framed(Framer(), Seq(ByteString.fromArrayUnsafe(got)))
      check(
        answers.forall {
          case Framed.Complete(f) => RpcMessage.fromServer(f).isInstanceOf[RpcMessage.Reply]; case _ => false
        },
        s"not replies, $clue"
      )
      replies += answers.length
      if wanted.isEmpty then
        check(
          answers.length == requestsIn(bytes),
          s"${answers.length} replies to ${requestsIn(bytes)}, $clue"
        )
      check(Await.result(ping, 10.seconds) == Right(Int32(i)), s"the healthy client was harmed, $clue")
      healthy += 1
    val reasons = server.stats.closedWithReason
    Await.result(client.close(), 10.seconds)
    Await.result(server.close(), 10.seconds)
    ServerFigures(sequences, reasons, replies, healthy)

  /** @param right number of results, each sent for exactly this call
    * @param failed number of calls that ended with the correct error
    */
  final case class ClientFigures(sequences: Int, right: Int, refused: Int, failed: Int)

  /** Checks that every call ends, and with a result only if exactly that result was sent for it. */
  def client(sequences: Int, seed: Long)(using system: ActorSystem): ClientFigures =
    val socket = ServerSocket(0, 50, InetAddress.getLoopbackAddress)
    val sent   = LinkedBlockingQueue[(Long, Array[Byte])]()
    val peer   = Thread.ofPlatform().daemon().start: () =>
      for i <- 0 until sequences do
        val connection = socket.accept()
        try
          val id    = readRequest(connection)
          val bytes = Mutation.of(Random(seed + i), Mutation.reply(id))
          sent.put(id -> bytes)
          connection.getOutputStream.write(bytes)
        catch case _: IOException => ()
        finally connection.close()
    val settings = RpcSettings(
      controlConnections = 1,
      backOff = BackOff(Span.ofMillis(0.1), Span.ofMillis(0.2)),
      limits = frameLimits
    )
    val gone   = LinkedBlockingQueue[RpcEvent]()
    val client = RpcClient(
      TcpTransport(),
      loopback(socket.getLocalPort),
      Clock.system,
      settings,
      seed,
      observer =
        case event: RpcEvent.Disconnected => gone.put(event)
        case _                            => ()
    )
    var right, refused, failed = 0
    for i <- 0 until sequences do
      val clue        = s"seed ${seed + i}"
      val result      = Await.result(client.call("read", Seq.empty), 20.seconds)
      val (id, bytes) = sent.poll(10, TimeUnit.SECONDS)
      (firstReply(bytes, id), result) match
        case (Some(RpcMessage.Reply(_, Null, value: Msg)), Right(got)) =>
          check(same(got, value), s"got $got, expected $value, $clue")
          right += 1
        case (Some(RpcMessage.Reply(_, error, _)), Left(RpcError.Refused(_, text))) if error != Null =>
          check(text == RpcMessage.errorText(error), clue)
          refused += 1
        case (None, Left(_: RpcError.Malformed | _: RpcError.ConnectionLost)) => failed += 1
        case (expected, got) => throw AssertionError(s"got $got, expected $expected, $clue")
      check(gone.poll(10, TimeUnit.SECONDS) != null, s"the connection was not seen to end, $clue")
    check(client.stats.pending == 0, "calls left over")
    Await.result(client.close(), 10.seconds)
    socket.close()
    peer.join(10_000)
    ClientFigures(sequences, right, refused, failed)

  private val frameLimits = FrameLimits(frameBytes = 1 << 20, depth = 32, elements = 1 << 16)

  private def loopback(port: Int) = Address("127.0.0.1", port)

  private def echo(request: RpcRequest): Future[Either[String, Msg]] =
    Future.successful(request.params.headOption.toRight("no parameter"))

  /** Sends the bytes, finishes sending, and reads until the server closes. */
  private def exchange(port: Int, bytes: Array[Byte]): Array[Byte] =
    val socket = Socket(InetAddress.getLoopbackAddress, port)
    try
      socket.setSoTimeout(10_000)
      socket.getOutputStream.write(bytes)
      socket.shutdownOutput()
      socket.getInputStream.readAllBytes()
    catch
      case timeout: java.net.SocketTimeoutException => throw timeout
      case _: IOException                           => Array.emptyByteArray // reset, with input unread
    finally socket.close()

  private def readRequest(connection: Socket): Long =
    val framer  = Framer()
    val segment = new Array[Byte](256)
    var id      = Option.empty[Long]
    while id.isEmpty do
      val count = connection.getInputStream.read(segment)
      if count < 0 then throw IOException("closed")
      for case Framed.Complete(frame) <- Wire.framed(framer, Seq(ByteString.fromArray(segment, 0, count))) do
        RpcMessage.fromClient(frame) match
          case request: RpcMessage.Request => id = Some(request.id)
          case other                       => throw AssertionError(s"not a request: $other")
    id.get

  /** Values up to the first malformed one, and the reason why it is malformed. */
  private def decoded(
      bytes: Array[Byte],
      decode: Array[Byte] => RpcMessage
  ): (Seq[RpcMessage], Option[String]) =
    val framer   = Framer(frameLimits)
    val messages = Wire
      .framed(framer, Seq(ByteString.fromArrayUnsafe(bytes)))
      .map:
        case Framed.Complete(frame) => decode(frame)
        case other                  => RpcMessage.Malformed(other.asInstanceOf[Framed.Malformed].reason)
    val reason = messages.collectFirst { case RpcMessage.Malformed(reason) => reason }
    val cut    = Option.when(framer.midway)("the peer stopped in the middle of a message")
    (messages.takeWhile(!_.isInstanceOf[RpcMessage.Malformed]), reason.orElse(cut))

  /** Before the first request nothing else may be sent; data whose first byte is foreign are not read. */
  private def expectedReason(bytes: Array[Byte]): Option[String] =
    FirstBytes.verdict(ByteString.fromArrayUnsafe(bytes), ServerConnection.Starts) match
      case FirstBytes.Foreign(what) => Some(s"expected a message of MessagePack-RPC, got $what")
      case _                        =>
        val (messages, reason) = decoded(bytes, RpcMessage.fromClient)
        messages.headOption
          .collect { case RpcMessage.Ignored(what) =>
            s"expected a message of MessagePack-RPC first, got $what"
          }
          .orElse(reason)

  private def requestsIn(bytes: Array[Byte]): Int =
    decoded(bytes, RpcMessage.fromClient)._1.count(_.isInstanceOf[RpcMessage.Request])

  private def firstReply(bytes: Array[Byte], id: Long): Option[RpcMessage.Reply] =
    decoded(bytes, RpcMessage.fromServer)._1.collectFirst {
      case reply: RpcMessage.Reply if reply.id == id => reply
    }

  private def same(a: Msg, b: Msg): Boolean = java.util.Arrays.equals(upack.write(a), upack.write(b))

  private def check(holds: Boolean, clue: => String): Unit = if !holds then throw AssertionError(clue)
