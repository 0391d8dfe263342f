package skein.solver

import javax.net.ssl.SSLException
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Flow, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.DurationInt
import scala.concurrent.{ExecutionContext, Future}
import skein.link.*
import skein.units.*
import skein.vtime.VirtualTime

/** Links in virtual time, whose attempts to connect follow a script. */
class TcpLinkSuite extends munit.FunSuite:
  private val at      = Address("solver", 7400)
  private val message = ByteString(SolverMessageCodec.bytes(SolverMessage.Unknown(5)))

  private type Attempt = Flow[ByteString, ByteString, Future[Done]]

  private def failing(why: Throwable): Attempt = Flow
    .fromSinkAndSourceCoupled(Sink.ignore, Source.failed[ByteString](why))
    .mapMaterializedValue(_ => Future.failed(why))

  private def open(says: Source[ByteString, Any], hears: Sink[ByteString, Any] = Sink.ignore): Attempt =
    Flow.fromSinkAndSource(hears, says).mapMaterializedValue(_ => Future.successful(Done))

  private val mistrusted = TransportError.NotTrusted(at, SSLException("who?"))
  private val nobody     = TransportError.NobodyListens(at)
  private val framed     = ByteString(0, 0, 0, message.size.toByte) ++ message
  private val saying     = Source.single(framed).initialDelay(50.millis)

  /** The events of a link within some seconds.
    *
    * @param attempts results of the first attempts; the last one repeats
    */
  private final class Trial(attempts: Attempt*)(using system: ActorSystem):
    var news     = Vector.empty[LinkNews]
    var received = Vector.empty[ByteString]
    var tried    = 0

    private val transport = new Transport:
      def connect(to: Address) =
        Flow
          .fromMaterializer: (_, _) =>
            tried += 1
            attempts((tried - 1).min(attempts.size - 1))
          .mapMaterializedValue(_.flatten)
      def listen(at: Address) = throw AssertionError("nobody listens here")

    val link = TcpLink(transport, at, answerWithin = Span.ofSeconds(10))
      .open(bytes => received :+= ByteString(bytes), news :+= _)

  private def within[A](seconds: Double, attempts: Attempt*)(then_ : Trial => Future[A]): (Trial, A) =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val trial              = Trial(attempts*)
        after(Span.ofSeconds(seconds).toDuration, system.scheduler)(Future.unit)
          .flatMap(_ => then_(trial))
          .map((trial, _))
      .value

  private def closing(trial: Trial): Future[Done] = trial.link.close()

  test("a side that is not trusted at two attempts in a row is refused, without retries"):
    val (trial, _) = within(3, failing(mistrusted))(_ => Future.unit)
    assertEquals(trial.news, Vector(LinkNews.Refused(mistrusted.getMessage)))
    assertEquals(trial.tried, 2)

  test("a handshake that fails only once, or after a message, is not reported as a refusal"):
    val no   = failing(mistrusted)
    val said = open(
      Source(Seq(framed, ByteString.empty))
        .throttle(1, 50.millis)
        .map(bytes => if bytes.isEmpty then throw mistrusted else bytes)
    )
    val (trial, _) = within(3, no, failing(nobody), no, said, no)(closing)
    assertEquals(trial.received, Vector(message))
    assertEquals(trial.news, Vector(LinkNews.Up, LinkNews.Down(mistrusted.getMessage)))
    assert(clue(trial.tried) > 5)

  test("a lost connection is reported, and opened again until the link is closed"):
    val (trial, tried) = within(3, failing(nobody), open(saying), open(Source.maybe)): trial =>
      val tried = trial.tried
      closing(trial).map(_ => tried)(using ExecutionContext.parasitic)
    assertEquals(tried, 3)
    assertEquals(
      trial.news,
      Vector(LinkNews.Up, LinkNews.Down(s"the solver at $at closed the connection"), LinkNews.Up)
    )

  test("messages sent before a connection are refused with the reason, and accepted ones are sent on close"):
    var heard      = ByteString.empty
    val hears      = Sink.foreach[ByteString](bytes => heard ++= bytes)
    val echo       = Flow.fromSinkAndSourceCoupled(hears, Source.maybe[ByteString])
    val (_, early) = within(1, failing(nobody))(trial => Future.successful(trial.link.send(message.toArray)))
    assertEquals(early, Left(nobody.getMessage))
    val (_, sent) =
      within(1, echo.mapMaterializedValue(_ => Future.successful(Done))): trial =>
        val sent = trial.link.send(message.toArray)
        closing(trial).map(_ => sent)(using ExecutionContext.parasitic)
    assertEquals((sent, heard), (Right(()), framed))

  test("a side that sends nothing in time is refused"):
    val (trial, _) = within(11, open(Source.maybe))(_ => Future.unit)
    assertEquals(
      trial.news,
      Vector(
        LinkNews.Up,
        LinkNews.Refused(
          s"who listens at $at takes the connection, but has said nothing for 10 s; expected ./skein decide there"
        )
      )
    )
