package skein.cli

import java.util.concurrent.Executors
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.http.scaladsl.Http
import org.apache.pekko.http.scaladsl.model.*
import org.apache.pekko.http.scaladsl.model.headers.Origin
import org.apache.pekko.stream.scaladsl.Sink
import scala.concurrent.{ExecutionContext, Future}
import skein.cluster.{CoordinatorNode, Endpoint}
import skein.view.{Access, HttpSystem}

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
      val few                   = "max-connections = 32\nrequest-timeout = 10s"
      given system: ActorSystem =
        HttpSystem("skein-metrics", ExecutionContext.fromExecutorService(threads), few)
      given ExecutionContext = ExecutionContext.parasitic
      val bound              = Http()
        .newServerAt(listen.host, listen.port)
        .connectionSource()
        .to(Sink.foreach: connection =>
          val access = Option.when(listen.isLoopback)(Access(connection.localAddress.getPort))
          connection.handleWithSyncHandler(answer(_, access, text)): Unit)
        .run()
      val serving = bound
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

  private def answer(request: HttpRequest, access: Option[Access], text: () => String)(using
      ActorSystem
  ): HttpResponse =
    request.discardEntityBytes()
    val origin = request.header[Origin].map(_.origins.mkString(" "))
    access.flatMap(_.refusal(request.uri.authority.toString, origin)) match
      case Some(why)                                 => plain(StatusCodes.Forbidden, why)
      case None if request.method != HttpMethods.GET => plain(StatusCodes.MethodNotAllowed, "expected GET")
      case None if request.uri.path.toString == "/metrics" =>
        HttpResponse(entity = HttpEntity(Prometheus, text().getBytes("UTF-8")))
      case None => plain(StatusCodes.NotFound, "expected /metrics")

  private def plain(status: StatusCode, why: String) = HttpResponse(status, entity = why + "\n")

  private lazy val Prometheus =
    ContentType.parse(CoordinatorNode.MetricsType).fold(
      wrong => throw IllegalStateException(wrong.toString),
      identity
    )
