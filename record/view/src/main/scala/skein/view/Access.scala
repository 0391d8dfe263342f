package skein.view

import java.net.InetAddress
import scala.util.Try

/** Decides which HTTP requests are accepted: those of programs, and of pages that the server itself serves. A
  * browser's page of another site is refused, even under a name that it has directed to this machine (DNS
  * rebinding).
  *
  * Headers are compared as texts. So an invalid header counts as foreign, like one that names another site,
  * and never as absent.
  *
  * @param port that it listens on
  * @param host that it listens on, an address of IPv6 in brackets
  * @param isLoopback whether only this machine can reach it. Otherwise requests may use any address and names
  *   without a dot, which cannot be registered, besides `host` and `names`
  * @param names of this machine
  * @param origins pages of other sites that are accepted nevertheless, for example `https://app.foxglove.dev`
  */
final case class Access(
    port: Int,
    host: String = "127.0.0.1",
    isLoopback: Boolean = true,
    names: Set[String] = Set.empty,
    origins: Set[String] = Set.empty
):
  import Access.*

  private val own = Loopback ++ names + host

  /** Why a request is refused, if it is.
    *
    * @param headers all names in lower case, and values, as received
    */
  def refusal(headers: Iterable[(String, String)]): Option[String] =
    def said(name: String) = headers.collect { case (`name`, value) => value }.toVector
    (said("host"), said("origin")) match
      case (Vector(at), from) if isOwnHost(at) =>
        from match
          case Vector()                                          => None
          case Vector(one) if isOwnPage(one, at) || origins(one) => None
          case _ => Some("pages of other sites may not look; start with --view-origin to let one")
      case _ =>
        Some(s"expected one of ${own.toVector.sorted.map(name => s"$name:$port").mkString(", ")} as the host")

  private def isOwnHost(said: String) =
    val name =
      if said.endsWith(s":$port") then Some(said.dropRight(s":$port".length))
      else Option.when(port == DefaultPort)(said)
    name.exists(one => own(one) || !isLoopback && (isPlain(one) || isAddress(one)))

  private def isOwnPage(origin: String, at: String) =
    origin.startsWith(Scheme) && {
      val from = origin.drop(Scheme.length)
      from == at || isLoopback && isOwnHost(from)
    }

object Access:
  private val Loopback = Set("127.0.0.1", "localhost", "[::1]")
  private val Scheme   = "http://"

  /** The port that browsers leave out. */
  private val DefaultPort = 80

  private def isPlain(name: String) =
    name.nonEmpty && name.forall(letter => letter.isLetterOrDigit || letter == '-')

  private def isAddress(name: String) =
    Try(InetAddress.ofLiteral(name)).isSuccess && (name.count(_ == '.') == 3 || name.startsWith("["))
