package skein.cli

import java.net.InetAddress
import java.util.concurrent.Executors
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.http.scaladsl.model.*
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Try
import skein.cluster.{CoordinatorNode, Endpoint}
import skein.link.{Address, Seats}
import skein.units.Clock
import skein.view.{Access, HttpPort, HttpSystem}

/** Tells how it goes to whoever asks over HTTP, `GET /metrics`: Prometheus, or a person. It has an actor
  * system and a thread of its own.
  */
private[cli] object MetricsServer:

  /** Serves while `body` runs.
    *
    * @param listen port 0 for any that is free
    * @param text in Prometheus' format, asked for again each time
    * @param say told where it is to be read
    * @return of `body`, or why it cannot listen
    */
  def serving[A](listen: Endpoint, text: () => String, say: String => Unit)(
      body: => Either[String, A]
  ): Either[String, A] =
    val threads = Executors.newSingleThreadExecutor(Thread.ofPlatform.daemon.name("skein-metrics").factory)
    try
      given system: ActorSystem =
        HttpSystem("skein-metrics", ExecutionContext.fromExecutorService(threads), "request-timeout = 10s")
      given ExecutionContext = ExecutionContext.parasitic
      val names              = if listen.isLoopback then Set.empty[String] else ownNames
      val serving            = HttpPort
        .bind(
          listen.host,
          listen.port,
          Seats(MostConnections, Clock.system),
          Access(_, Address(listen.host, listen.port).uriHost, listen.isLoopback, names)
        )((request, _) => answer(request, text))
        .map(Right(_))
        .recover(error => Left(s"--metrics: cannot listen at $listen: ${error.getMessage}"))
      try
        Edge.await(serving).flatMap: binding =>
          say(s"metrics at http://${listen.copy(port = binding.localAddress.getPort)}/metrics")
          try body
          finally Edge.await(binding.unbind()): Unit
      finally Edge.await(ended(system)): Unit
    finally threads.shutdown()

  private def ended(system: ActorSystem): Future[Done] =
    system.terminate().map(_ => Done)(using ExecutionContext.parasitic)

  private def answer(request: HttpRequest, text: () => String)(using ActorSystem): HttpResponse =
    request.discardEntityBytes()
    if request.method != HttpMethods.GET then plain(StatusCodes.MethodNotAllowed, "expected GET")
    else if request.uri.path.toString == "/metrics" then
      HttpResponse(entity = HttpEntity(Prometheus, text().getBytes("UTF-8")))
    else plain(StatusCodes.NotFound, "expected /metrics")

  /** By which others may know this machine. */
  private def ownNames: Set[String] =
    Try(InetAddress.getLocalHost).toOption.toSet.flatMap(own =>
      Set(own.getHostName, own.getCanonicalHostName)
    )

  private val MostConnections = 32

  private def plain(status: StatusCode, why: String) = HttpResponse(status, entity = why + "\n")

  private lazy val Prometheus =
    ContentType.parse(CoordinatorNode.MetricsType).fold(
      wrong => throw IllegalStateException(wrong.toString),
      identity
    )
