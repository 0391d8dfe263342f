package skein.cli

import java.nio.file.Path
import java.util.concurrent.atomic.AtomicInteger
import javax.net.ssl.{SSLContext, SSLSocket}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.cluster.{Certificates, Tls}
import skein.flight.SolvedFlight
import skein.link.{Address, Listening, TcpTransport, TransportError}
import skein.loop.FlightOutcome
import skein.scenario.Scenarios
import skein.settings.SolverChoice
import skein.solver.*
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.*

/** Solvers with certificates that require clients' certificates, on loopback. */
class SolverTlsLiveSuite extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given system: ActorSystem = ActorSystem("SolverTlsLiveSuite")
  private given Scenarios           = Scenarios.ours
  import system.dispatcher

  override def afterAll(): Unit =
    Await.result(system.terminate(), 20.seconds): Unit
    super.afterAll()

  private def certificates(hosts: String*): Vector[SSLContext] =
    def context(folder: Path) = Tls.of(folder).flatMap(_.context).fold(fail(_), identity)
    Certificates.make(temporaryFolder(), hosts).fold(fail(_), identity).map(context)

  private lazy val Vector(own, elsewhere) = certificates("127.0.0.1", "*.workers.lab"): @unchecked
  private lazy val stranger               = certificates("127.0.0.1").head

  private def transport(certificates: Option[SSLContext]) = TcpTransport(certificates = certificates)

  private val loopback = Address("127.0.0.1", 0)

  /** A server that echoes its input, and counts it. */
  private def echoing[A](shows: SSLContext)(body: (Listening, AtomicInteger) => A): A =
    val heard = AtomicInteger()
    val echo  = Flow[ByteString].map: bytes =>
      heard.addAndGet(bytes.size): Unit
      bytes
    val server = Await.result(
      transport(Some(shows)).listen(loopback).to(Sink.foreach(_.flow.join(echo).run(): Unit)).run(),
      20.seconds
    )
    try body(server, heard)
    finally Await.result(server.close(), 20.seconds): Unit

  private def exchanged(to: Address, by: Option[SSLContext]): Future[String] =
    Source
      .single(ByteString("geese"))
      .concat(Source.maybe)
      .via(transport(by).connect(to))
      .take(1)
      .runFold(ByteString.empty)(_ ++ _)
      .map(_.utf8String)

  private def failure(exchange: Future[String]): Throwable = Await.result(exchange.failed, 30.seconds)

  test("with certificates of one set, both sides receive each other's messages"):
    echoing(own): (server, _) =>
      assertEquals(Await.result(exchanged(server.address, Some(own)), 30.seconds), "geese")

  test("a peer without a certificate, with one of another set, or with an older TLS is not accepted"):
    echoing(own): (server, heard) =>
      assert(clue(failure(exchanged(server.address, Some(stranger)))).isInstanceOf[TransportError.NotTrusted])
      // A peer without TLS is disconnected, and receives no answer.
      val plain = Await.ready(exchanged(server.address, None), 30.seconds).value.get
      assertNotEquals(plain.getOrElse(""), "geese")
      val socket = own.getSocketFactory.createSocket("127.0.0.1", server.address.port).asInstanceOf[SSLSocket]
      try
        socket.setEnabledProtocols(Array("TLSv1.2"))
        intercept[java.io.IOException](socket.startHandshake()): Unit
      finally socket.close()
      assertEquals(heard.get, 0)

  test("a server with a certificate of another host, or of another set, receives no data"):
    for shown <- Seq(elsewhere, stranger) do
      echoing(shown): (server, heard) =>
        val why = failure(exchanged(server.address, Some(own)))
        assert(clue(why).isInstanceOf[TransportError.NotTrusted])
        assertEquals(heard.get, 0)

  private def served[A](shows: SSLContext)(body: Address => A): A =
    val server =
      Await.result(
        SolverServer.start(loopback, transport(Some(shows)), SolvedFlight.desk(), Clock.system),
        20.seconds
      )
    try body(server.address)
    finally Await.result(server.close(), 20.seconds): Unit

  test("a flight that does not trust its solver, or is not trusted, fails long before its patience ends"):
    for
      (solvers, flights, who) <- Seq(
        (stranger, own, "whose side is refused here"),
        (elsewhere, own, "whose side is refused here"),
        (own, stranger, "refuse")
      )
    do
      served(solvers): at =>
        val link   = TcpLink(transport(Some(flights)), at)
        val flight = SolvedFlight(SolverChoice.Tcp(at), link, patience = Span.ofSeconds(600))
        val why    = Await.result(flight.start(), 30.seconds).swap.getOrElse(fail("it was flown"))
        assert(clue(why).contains(s"no trusted connection to $at, "))
        assert(clue(why).contains(who))

  test("a flight without certificates fails with that reason long before its patience ends"):
    served(own): at =>
      val link   = TcpLink(transport(None), at, () => SolverOptions.wantsTls(at))
      val flight = SolvedFlight(SolverChoice.Tcp(at), link, patience = Span.ofSeconds(600))
      val why    = Await.result(flight.start(), 30.seconds).swap.getOrElse(fail("it was flown"))
      assert(clue(why).contains(s"the solver at $at asks for certificates; expected --tls FOLDER"))

  test("a flight with certificates reports what its solver lacks long before its patience ends"):
    val server = Await.result(
      SolverServer.start(loopback, transport(None), SolvedFlight.desk(), Clock.system),
      20.seconds
    )
    try
      val at     = server.address
      val link   = TcpLink(transport(Some(own)), at, () => SolverOptions.lacksTls(at))
      val flight = SolvedFlight(SolverChoice.Tcp(at), link, patience = Span.ofSeconds(600))
      val why    = Await.result(flight.start(), 30.seconds).swap.getOrElse(fail("it was flown"))
      assert(clue(why).contains(s"the solver at $at does not speak TLS; expected ./skein decide with --tls"))
    finally Await.result(server.close(), 20.seconds): Unit

  test("a flight with certificates checks whether an unknown solver has certificates, too"):
    // A link whose far side is down.
    val closing = transport(None).listen(loopback).to(Sink.foreach(
      _.flow.join(Flow.fromSinkAndSource(Sink.cancelled, Source.empty)).run(): Unit
    ))
    val server = Await.result(closing.run(), 20.seconds)
    try
      val at     = server.address
      val link   = TcpLink(transport(Some(own)), at, () => SolverOptions.lacksTls(at), SolverOptions.HasTls)
      val flight = SolvedFlight(SolverChoice.Tcp(at), link, patience = Span.ofSeconds(3))
      val why    = Await.result(flight.start(), 30.seconds).swap.getOrElse(fail("it was flown"))
      assert(clue(why).endsWith("; has ./skein decide there --tls, too?"))
    finally Await.result(server.close(), 20.seconds): Unit

  test("a solver decides a flight over TLS"):
    served(own): at =>
      val flight = SolvedFlight(SolverChoice.Tcp(at), TcpLink(transport(Some(own)), at))
      assertEquals(Await.result(flight.flown(), 60.seconds), FlightOutcome.Completed)
      assert(flight.recorder.recording.solved.sizeIs > 10)
