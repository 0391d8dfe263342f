package skein.rpc

import java.util.concurrent.LinkedBlockingQueue
import java.util.concurrent.TimeUnit.SECONDS
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Sink, Source}
import org.apache.pekko.stream.testkit.scaladsl.{TestSink, TestSource}
import org.apache.pekko.stream.testkit.{TestPublisher, TestSubscriber}
import org.apache.pekko.util.ByteString
import scala.concurrent.Future
import skein.link.{Address, Incoming, Listening, Transport}
import upack.{Msg, Null}

/** Connections whose peer the test plays. */
final class ScriptedTransport(using ActorSystem) extends Transport:
  private val opened = LinkedBlockingQueue[Peer]()

  /** While set, attempts to connect fail for this reason. */
  @volatile var refuse: Option[Throwable] = None

  def connect(to: Address): Flow[ByteString, ByteString, Future[Done]] =
    refuse match
      case Some(reason) =>
        Flow
          .fromSinkAndSource(Sink.ignore, Source.failed(reason))
          .mapMaterializedValue(_ => Future.failed(reason))
      case None =>
        Flow.fromSinkAndSourceMat(TestSink[ByteString](), TestSource[ByteString]()): (requests, replies) =>
          opened.put(Peer(requests, replies))
          Future.successful(Done)

  def listen(at: Address): Source[Incoming, Future[Listening]] =
    val reason = UnsupportedOperationException("only connects")
    Source.failed(reason).mapMaterializedValue(_ => Future.failed(reason))

  /** The peer of the next connection that was opened. */
  def peer(): Peer =
    Option(opened.poll(5, SECONDS)).getOrElse(throw AssertionError("no connection was opened"))

/** The server's end of one connection: decodes requests, and sends the test's answers. */
final class Peer(requests: TestSubscriber.Probe[ByteString], replies: TestPublisher.Probe[ByteString]):
  private val framer  = Framer()
  private val writer  = MessageWriter()
  private val pending = scala.collection.mutable.Queue.empty[RpcMessage.Request]

  def request(): RpcMessage.Request =
    while pending.isEmpty do
      for case Framed.Complete(frame) <- Wire.framed(framer, Seq(requests.requestNext())) do
        RpcMessage.fromClient(frame) match
          case request: RpcMessage.Request => pending.enqueue(request)
          case other                       => throw AssertionError(s"not a request: $other")
    pending.dequeue()

  def answer(id: Long, result: Msg = Null): Unit = send { writer.reply(id, Right(result)); writer.take() }
  def refuse(id: Long, text: String): Unit       = send { writer.reply(id, Left(text)); writer.take() }
  def send(bytes: ByteString): Unit              =
    val _ = replies.sendNext(bytes)
  def close(): Unit =
    val _ = replies.sendComplete()
  def fail(reason: String): Unit =
    val _ = replies.sendError(RuntimeException(reason))

  /** Waits until the client has closed its side. */
  def expectClosed(): Unit =
    val _ = requests.ensureSubscription().request(1).expectComplete()
