package skein.view

import java.util.concurrent.atomic.AtomicInteger
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.http.scaladsl.Http
import org.apache.pekko.http.scaladsl.model.*
import org.apache.pekko.http.scaladsl.model.headers.RawHeader
import org.apache.pekko.stream.{KillSwitches, SharedKillSwitch}
import org.apache.pekko.stream.scaladsl.{Flow, Sink, Source}
import scala.concurrent.{ExecutionContext, Future}
import skein.link.Seats

/** A port that speaks HTTP. The number of connections is limited; an idle connection is closed to make room
  * for a new one. Requests from pages of other sites are refused, and browsers show answers only to the
  * server's own pages.
  */
object HttpPort:

  /** Listens on loopback.
    *
    * @param port 0 for any that is free
    * @param access the access rules for the port on which it listens
    * @param answer must not block; an answer that is not an error counts as activity
    * @return fails if it cannot listen
    */
  def bind(port: Int, seats: Seats, access: Int => Access)(
      answer: (HttpRequest, Guest) => HttpResponse
  )(using ActorSystem): Future[Http.ServerBinding] =
    def served(request: HttpRequest, guest: Guest, who: Access): HttpResponse =
      val response = who.refusal(request.headers.map(header => (header.lowercaseName, header.value))) match
        case None      => answer(request, guest)
        case Some(why) =>
          request.discardEntityBytes()
          HttpResponse(StatusCodes.Forbidden, entity = why)
      if response.status.isSuccess then guest.spoke()
      if response.status == StatusCodes.SwitchingProtocols then response else response.mapHeaders(guards ++ _)
    Http()
      .newServerAt("127.0.0.1", port)
      .connectionSource()
      .to(Sink.foreach: connection =>
        val switch = KillSwitches.shared("http-connection")
        seats.enter(() => switch.shutdown()) match
          case None =>
            connection.handleWith(Flow.fromSinkAndSourceCoupled(Sink.cancelled, Source.empty)): Unit
          case Some(seat) =>
            val guest = Guest(seat, switch)
            val who   = access(connection.localAddress.getPort)
            connection.handleWith(guest.during(Flow[HttpRequest].map(served(_, guest, who)))): Unit)
      .run()

  /** One connection, with its seat at the port. */
  final class Guest private[HttpPort] (seat: Seats.Seat, switch: SharedKillSwitch):
    // A WebSocket outlives the requests of its connection.
    private val running = AtomicInteger()

    /** Marks the connection as active. */
    def spoke(): Unit = seat.spoke()

    /** A flow during which the connection keeps its seat; the flow ends when the seat is lost. */
    def during[A, B](flow: Flow[A, B, ?]): Flow[A, B, ?] =
      running.incrementAndGet(): Unit
      flow
        .via(switch.flow)
        .watchTermination()((_, ended) =>
          ended.onComplete(_ => if running.decrementAndGet() == 0 then seat.left())(using
            ExecutionContext.parasitic
          )
        )

  private val guards = Vector(
    "Content-Security-Policy" -> (
      "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; " +
        "img-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options"       -> "nosniff",
    "Referrer-Policy"              -> "no-referrer",
    "Cross-Origin-Resource-Policy" -> "same-origin",
    "Cache-Control"                -> "no-store"
  ).map(RawHeader(_, _))
