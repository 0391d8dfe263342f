package skein.cli

import java.util.concurrent.Executors
import mainargs.{Flag, ParserForClass, arg}
import scala.concurrent.ExecutionContext
import skein.units.Clock
import skein.view.{Shows, Token, ViewServer}

/** Options for viewing a flight in the browser. */
final case class ViewOptions(
    @arg(doc = "shows it in the browser and in Foxglove; the address is printed")
    view: Flag,
    @arg(
      name = "view-port",
      doc = "port of --view, on this machine alone; 0 for any free port (default: 8765)"
    )
    viewPort: Option[Int],
    @arg(
      name = "view-origin",
      doc =
        "another site whose pages may connect, for example https://app.foxglove.dev; can be repeated"
    )
    viewOrigin: Seq[String]
):
  /** Serves `shows` while `body` runs, if requested.
    *
    * @param controlled whether the page can control the flights
    */
  def serving[A](shows: Shows, controlled: Boolean = false)(body: => Either[String, A]): Either[String, A] =
    val port = viewPort.getOrElse(ViewServer.DefaultPort)
    mistake match
      case Some(line)       => Left(line)
      case _ if !view.value => body
      case _                =>
        // Not in the scheduler's idle class: a user can abort a flight on a busy machine, too.
        val threads = Executors.newSingleThreadExecutor(Thread.ofPlatform.daemon.name("skein-view").factory)
        val token   = Token.drawn()
        try
          Edge.await(
            ViewServer
              .start(
                shows,
                Clock.system,
                ExecutionContext.fromExecutorService(threads),
                port,
                viewOrigin.toSet,
                token
              )
              .map(Right(_))(using ExecutionContext.parasitic)
              .recover {
                case error if s"${error.getMessage}${error.getCause}".contains("in use") =>
                  Left(s"--view-port: port $port is in use; expected a free one, or 0 for any")
                case error => Left(s"--view-port: cannot listen on $port: ${error.getMessage}")
              }(using ExecutionContext.parasitic)
          ).flatMap: server =>
            Console.err.println(
              s"to be seen at ${server.url}, and in Foxglove at ws://127.0.0.1:${server.port}" +
                (if controlled then s"; token of the page's controls: ${token.word}" else "")
            )
            try body
            finally Edge.await(server.close()): Unit
        finally threads.shutdown()

  /** Options that would have no effect, or contradict each other. */
  private[cli] def mistake: Option[String] =
    def alone(name: String, is: Boolean) = Option.when(is && !view.value)(s"$name: expected with --view")
    alone("--view-port", viewPort.isDefined)
      .orElse(alone("--view-origin", viewOrigin.nonEmpty))
      .orElse(viewPort.filter(port => port < 0 || port > 65535).map(port =>
        s"--view-port: expected 0 to 65535, got $port"
      ))
      .orElse(viewOrigin.find(!_.matches(ViewOptions.Site)).map(came =>
        "--view-origin: expected a site as browsers name it, for " +
          s"example https://app.foxglove.dev, got '$came'"
      ))

object ViewOptions:
  /** A site: scheme, host, and a port if it is not the scheme's own. */
  private val Site = "[a-z][a-z0-9+.-]*://[^/\\s]+"

  given ParserForClass[ViewOptions] = ParserForClass[ViewOptions]
