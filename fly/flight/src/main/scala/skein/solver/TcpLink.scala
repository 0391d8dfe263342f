package skein.solver

import java.util.concurrent.atomic.AtomicReference
import org.apache.pekko.{Done, NotUsed}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.{BoundedSourceQueue, KillSwitches, QueueOfferResult}
import org.apache.pekko.stream.scaladsl.{BidiFlow, Flow, Framing, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.{Future, Promise}
import scala.util.{Failure, Success, Try}
import skein.link.{Address, Transport, TransportError}
import skein.units.Decimals.brief
import skein.units.Span

/** Messages with a prefix of 4 bytes for their length, on one connection, which is opened again when it is
  * lost; over sockets and in virtual time. The link is refused if one side does not trust the other, twice
  * and before any message; and if the other side accepts the connection and sends nothing, with or without
  * certificates, for `answerWithin`.
  *
  * @param whyClosed called once, when the other side has closed a connection before any message: why it will
  *   always do so, if that is known; then the link is refused
  * @param perhaps added to the error of such a connection, if the cause is unknown
  * @param answerWithin time-out of the very first message
  */
final class TcpLink(
    transport: Transport,
    to: Address,
    whyClosed: () => Future[Option[String]] = () => Future.successful(None),
    perhaps: String = "",
    answerWithin: Span = TcpLink.AnswerWithin
)(using system: ActorSystem) extends MessageLink:
  import TcpLink.*
  import system.dispatcher

  def open(received: Array[Byte] => Unit, news: LinkNews => Unit): OpenLink =
    val link = Link(received, news)
    link.connect()
    link

  private final class Link(received: Array[Byte] => Unit, news: LinkNews => Unit) extends OpenLink:
    private val switch = KillSwitches.shared("solver-link")
    private val queue  = AtomicReference(Option.empty[BoundedSourceQueue[ByteString]])
    private val closed = Promise[Done]()

    @volatile private var isClosing = false
    @volatile private var hasHeard  = false
    @volatile private var hasAsked  = false
    @volatile private var mistrusts = 0
    @volatile private var whyDown   = s"no connection to $to yet"

    def connect(): Unit =
      val ((out, connected), ended) = Source
        .queue[ByteString](MostWaiting)
        .via(switch.flow)
        .viaMat(framed.joinMat(transport.connect(to))(Keep.right))(Keep.both)
        .via(switch.flow)
        .toMat(Sink.foreach: message =>
          hasHeard = true
          received(message.toArrayUnsafe()))(Keep.both)
        .run()
      // In this order, also if the peer closes as soon as it has accepted.
      val up = connected.map: _ =>
        queue.set(Some(out))
        news(LinkNews.Up)
        system.scheduler.scheduleOnce(answerWithin.toDuration)(unlessHeard(out)): Unit
      up.transformWith(_ => ended).onComplete: result =>
        val wasUp = queue.getAndSet(None).isDefined
        completed(out)
        val ending = result match
          case Failure(error) => error.getMessage
          case Success(_)     => s"the solver at $to closed the connection"
        whyDown = if wasUp && !hasHeard then ending + perhaps else ending
        // A solver that goes away in the middle of a handshake looks like this, too; but not twice.
        mistrusts = result match
          case Failure(_: TransportError.NotTrusted) if !hasHeard => mistrusts + 1
          case _                                                  => 0
        if isClosing then closed.trySuccess(Done): Unit
        else if mistrusts == MostMistrusts then refused(whyDown)
        else
          if wasUp then news(LinkNews.Down(whyDown))
          val asks = wasUp && !hasHeard && !hasAsked
          hasAsked ||= asks
          val known = if asks then whyClosed().recover(_ => None) else Future.successful(None)
          known.foreach:
            case Some(why) if !isClosing => refused(why)
            case _                       => again()

    private def unlessHeard(out: BoundedSourceQueue[ByteString]): Unit =
      if !hasHeard && !isClosing && queue.get.contains(out) then
        isClosing = true
        switch.shutdown()
        refused(
          s"who listens at $to takes the connection, but has said nothing for ${answerWithin.toSeconds.brief} s; " +
            s"expected ./skein decide there"
        )

    private def refused(why: String): Unit =
      closed.trySuccess(Done): Unit
      news(LinkNews.Refused(why))

    private def again(): Unit =
      after(TryEvery.toDuration, system.scheduler)(Future.unit).foreach: _ =>
        if isClosing then closed.trySuccess(Done): Unit else connect()

    /** Completes the queue, unless another thread has done so. */
    private def completed(out: BoundedSourceQueue[ByteString]): Unit =
      val _ = Try(if !out.isCompleted then out.complete())

    def send(message: Array[Byte]): Either[String, Unit] = queue.get match
      case None      => Left(whyDown)
      case Some(out) =>
        out.offer(ByteString.fromArrayUnsafe(message)) match
          case QueueOfferResult.Enqueued                                  => Right(())
          case QueueOfferResult.QueueClosed | QueueOfferResult.Failure(_) => Left(whyDown)
          case QueueOfferResult.Dropped => Left(s"$MostWaiting messages to $to wait already")

    /** Closes the link; messages already accepted are sent first, if the other side reads them in time. */
    def close(): Future[Done] =
      isClosing = true
      queue.getAndSet(None) match
        case None      => switch.shutdown()
        case Some(out) =>
          completed(out)
          val late = system.scheduler.scheduleOnce(CloseWithin.toDuration)(switch.shutdown())
          closed.future.onComplete(_ => late.cancel())
      closed.future

object TcpLink:
  /** Maximum number of one side's messages that wait to be sent. */
  private[solver] val MostWaiting = 256

  val AnswerWithin: Span = Span.ofSeconds(10)

  private val TryEvery      = Span.ofMillis(200)
  private val CloseWithin   = Span.ofMillis(500)
  private val MostMistrusts = 2

  private[solver] val framed: BidiFlow[ByteString, ByteString, ByteString, ByteString, NotUsed] =
    BidiFlow.fromFlows(
      Flow[ByteString].via(Framing.simpleFramingProtocolEncoder(SolverMessageCodec.MostBytes)),
      Framing.simpleFramingProtocolDecoder(SolverMessageCodec.MostBytes)
    )
