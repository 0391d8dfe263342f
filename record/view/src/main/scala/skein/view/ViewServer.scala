package skein.view

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.http.scaladsl.Http
import org.apache.pekko.http.scaladsl.model.*
import org.apache.pekko.http.scaladsl.model.ws.{BinaryMessage, Message, TextMessage, WebSocketUpgrade}
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Flow, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future}
import scala.concurrent.duration.*
import skein.link.Seats
import skein.units.Clock

/** Serves the page and Foxglove's protocol for some flights, on loopback. It has an actor system of its own,
  * so that viewers and flights share no threads.
  *
  * `/` is the page, and over a WebSocket the first flight; `/flights/ID` is one flight over a WebSocket;
  * `/flights` lists them. In a path, an ID is percent-encoded. With the token in the header `X-Skein-Token`,
  * `POST /flights/ID/pause`, `…/continue` and `…/abort` control a flight ([[FlightControl]]), and
  * `POST /hover` pauses all.
  */
final class ViewServer private (
    binding: Http.ServerBinding,
    turning: () => Unit,
    shows: Shows,
    clock: Clock
)(using
    system: ActorSystem
):
  def port: Int = binding.localAddress.getPort

  def url: String = s"http://127.0.0.1:$port"

  /** Shows viewers the last messages, gives them a moment to receive these, and closes every connection. */
  def close(): Future[Done] =
    import system.dispatcher
    turning()
    val isWatched = shows.all.exists(_.watching > 0)
    binding
      .unbind()
      .transformWith: _ =>
        shows.all.foreach(_.attempt(clock.now()))
        if isWatched then after(ViewServer.LastMoment, system.scheduler)(Future.unit) else Future.unit
      .transformWith(_ => system.terminate())
      .map(_ => Done)

object ViewServer:

  /** The default port of Foxglove's protocol. */
  val DefaultPort = 8765

  /** Starts the server; the future fails if the port cannot be bound.
    *
    * @param threads executor of the server
    * @param port TCP port; 0 chooses a free one
    * @param origins further web origins whose pages may connect
    */
  def start(
      shows: Shows,
      clock: Clock,
      threads: ExecutionContext,
      port: Int = DefaultPort,
      origins: Set[String] = Set.empty,
      token: Token = Token.drawn(),
      limits: ViewerLimits = ViewerLimits()
  ): Future[ViewServer] =
    given system: ActorSystem =
      HttpSystem("skein-view", threads, "websocket.periodic-keep-alive-max-idle = 20s")
    import system.dispatcher
    HttpPort
      .bind(port, Seats(limits.connections, clock), Access(_, origins))(Answers(shows, clock, token)(_, _))
      .map: binding =>
        val turns = system.scheduler.scheduleWithFixedDelay(TurnEvery, TurnEvery)(() =>
          shows.all.foreach(_.attempt(clock.now()))
        )
        ViewServer(binding, () => turns.cancel(): Unit, shows, clock)
      .recoverWith { case error => system.terminate().transformWith(_ => Future.failed(error)) }

  private val TurnEvery = 25.millis

  private val LastMoment = 300.millis

  private val PartsWithin = 5.seconds

  private final class Answers(all: Shows, clock: Clock, token: Token)(using ActorSystem):
    def apply(request: HttpRequest, guest: HttpPort.Guest): HttpResponse =
      val shows                                    = all.all
      def refused(status: StatusCode, why: String) =
        request.discardEntityBytes()
        Page.answer(status, ContentTypes.`text/plain(UTF-8)`, why)
      val path  = request.uri.path.toString
      val place = segments(request.uri.path)
      (request.attributes.get(AttributeKeys.webSocketUpgrade), request.method) match
        case (Some(upgrade: WebSocketUpgrade), _) =>
          val found =
            if path == "/" then shows.headOption else shows.find(show => place == Vector("flights", show.id))
          found match
            case Some(show) => watch(upgrade, show, guest).getOrElse(
                refused(
                  StatusCodes.BadRequest,
                  s"expected one of the subprotocols ${Protocol.Names.mkString(", ")}"
                )
              )
            case None => refused(StatusCodes.NotFound, s"no flight at $path")
        case (_, HttpMethods.GET) if path == "/flights" =>
          Page.answer(
            StatusCodes.OK,
            ContentTypes.`application/json`,
            ujson.Arr.from(shows.map(listed)).render()
          )
        case (_, HttpMethods.GET) =>
          Page.file(path).getOrElse(refused(StatusCodes.NotFound, s"nothing at $path"))
        case (_, HttpMethods.POST) =>
          val said = request.headers.find(_.is("x-skein-token")).fold("")(_.value)
          (wanted(place, shows), token.is(said)) match
            case (_, false) =>
              refused(StatusCodes.Unauthorized, "expected the token that the terminal shows")
            case (Vector(), _) => refused(StatusCodes.NotFound, s"nothing to be done at $path")
            case (acts, true)  =>
              request.discardEntityBytes()
              acts.foreach(_())
              Page.answer(StatusCodes.OK, ContentTypes.`text/plain(UTF-8)`, "done")
        case _ => refused(StatusCodes.MethodNotAllowed, "expected GET or POST")

    private def listed(show: Show) =
      ujson.Obj(
        "id"       -> show.id,
        "controls" -> ujson.Arr.from(FlightControl.values.filter(show.controls.contains).map(_.word))
      )

    /** A path's parts, decoded: a flight's name may contain `%` and `/`. */
    private def segments(path: Uri.Path): Vector[String] = path match
      case Uri.Path.Empty               => Vector.empty
      case Uri.Path.Slash(rest)         => segments(rest)
      case Uri.Path.Segment(part, rest) => part +: segments(rest)

    private def wanted(place: Vector[String], shows: Vector[Show]): Vector[() => Unit] =
      if place == Vector("hover") then shows.flatMap(_.controls.get(FlightControl.Pause))
      else
        for
          show    <- shows
          control <-
            FlightControl.values.find(control => place == Vector("flights", show.id, control.word)).toVector
          act <- show.controls.get(control)
        yield act

    private def watch(upgrade: WebSocketUpgrade, show: Show, guest: HttpPort.Guest): Option[HttpResponse] =
      Protocol.Names
        .find(upgrade.requestedProtocols.contains)
        .map: name =>
          val stage = ViewerStage(show, clock, () => guest.spoke())
          upgrade.handleMessages(guest.during(whole(show.limits).via(stage)), Some(name))

    /** Joins the parts of messages; a message that is too long or too slow ends the connection. */
    private def whole(limits: ViewerLimits): Flow[Message, Message, ?] =
      given ExecutionContext = ExecutionContext.parasitic
      def gathered[A](parts: Source[A, ?], none: A)(size: A => Int, add: (A, A) => A)(message: A => Message) =
        parts
          .limitWeighted(limits.messageBytes)(size(_))
          .completionTimeout(PartsWithin)
          .runFold(none)(add)
          .map(all => Some(message(all)))
          .recover(_ => None)
      Flow[Message]
        .mapAsync(1):
          case whole: (TextMessage.Strict | BinaryMessage.Strict) => Future.successful(Some(whole))
          case text: TextMessage    => gathered(text.textStream, "")(_.length, _ + _)(TextMessage.Strict(_))
          case bytes: BinaryMessage =>
            gathered(bytes.dataStream, ByteString.empty)(_.length, _ ++ _)(BinaryMessage.Strict(_))
        .takeWhile(_.isDefined)
        .map(_.get)
