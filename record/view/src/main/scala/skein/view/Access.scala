package skein.view

/** The clients that an HTTP server of Skein's answers: programs, and the pages that it serves itself. A
  * browser's page of another site gets no answer, not even under a name that it has made resolve to this
  * machine (DNS rebinding).
  *
  * Headers are compared as texts. So an invalid header counts as foreign, like one with another site's name,
  * and never as absent.
  *
  * @param port the server's port on loopback
  * @param origins other sites whose pages are answered, too, for example `https://app.foxglove.dev`
  */
final case class Access(port: Int, origins: Set[String] = Set.empty):
  import Access.*

  /** The reason why a request is refused; None if it is accepted.
    *
    * @param headers the header fields: names in lower case, values as received
    */
  def refusal(headers: Iterable[(String, String)]): Option[String] =
    def said(name: String) = headers.collect { case (`name`, value) => value }.toVector
    (said("host"), said("origin")) match
      case (Vector(at), from) if isOwnHost(at) =>
        from match
          case Vector()                                      => None
          case Vector(one) if isOwnPage(one) || origins(one) => None
          case _ => Some("pages of other sites may not look; start with --view-origin to let one")
      case _ =>
        Some(s"expected one of ${Own.toVector.sorted.map(name => s"$name:$port").mkString(", ")} as the host")

  private def isOwnHost(said: String) =
    if said.endsWith(s":$port") then Own(said.dropRight(s":$port".length))
    else port == DefaultPort && Own(said)

  private def isOwnPage(origin: String) = origin.startsWith(Scheme) && isOwnHost(origin.drop(Scheme.length))

object Access:
  private val Own    = Set("127.0.0.1", "localhost", "[::1]")
  private val Scheme = "http://"

  /** HTTP's default port, which browsers leave out. */
  private val DefaultPort = 80
