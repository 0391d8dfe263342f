package skein.link

import java.nio.charset.StandardCharsets.US_ASCII
import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import org.apache.pekko.util.ByteString

/** Who speaks at the other end of a new connection, told by its first bytes. A browser opens connections to
  * any port for any page; what it sends begins as HTTP or as TLS does, with bytes of the page's choice behind
  * that. Such a connection is closed before anything that it says is obeyed.
  */
enum FirstBytes:
  /** Nothing is against it: the rest may be read. */
  case Own

  /** So far as a request of HTTP begins: the next bytes decide, and until then nothing is to be obeyed. */
  case Undecided

  /** @param what it is, for a person: "came …"
    */
  case Foreign(what: String)

object FirstBytes:
  /** Pure; to be asked again with all bytes so far while it is [[Undecided]].
    *
    * @param bytes of the connection, from its beginning
    * @param own the first bytes that the port's protocol knows, 0 to 255; empty: any that is not another
    *   protocol's
    */
  def verdict(bytes: ByteString, own: Set[Int] = Set.empty): FirstBytes = bytes.headOption match
    case None        => Undecided
    case Some(first) =>
      val method = Methods.find(word => word.startsWith(bytes.take(word.length)))
      method match
        case Some(word) if bytes.length >= word.length =>
          Foreign(s"an HTTP request (${word.utf8String.trim})")
        case Some(_) if own.isEmpty || own(first & 0xff) => Undecided
        case _ if first == Handshake && !own(Handshake)  => Foreign("a greeting of TLS")
        case _ if own.nonEmpty && !own(first & 0xff)     => Foreign(s"a first byte of 0x${Integer.toHexString(first & 0xff | 0x100).drop(1)}")
        case _                                           => Own

  /** Lets a connection's bytes through once its first ones are its own protocol's.
    *
    *   - '''Emits when''' bytes come that are decided upon.
    *   - '''Backpressures when''' downstream does.
    *   - '''Completes when''' upstream has completed.
    *   - '''Fails when''' the first bytes are foreign, with [[TransportError.Foreign]].
    *   - '''Cancels when''' downstream cancels, or it fails.
    */
  def guard(from: Address, own: Set[Int] = Set.empty): Flow[ByteString, ByteString, NotUsed] =
    // None: decided.
    Flow[ByteString].statefulMap(() => Option(ByteString.empty))(
      (kept, bytes) =>
        kept match
          case None         => (None, bytes)
          case Some(before) =>
            val all = before ++ bytes
            verdict(all, own) match
              case Own           => (None, all)
              case Undecided     => (Some(all), ByteString.empty)
              case Foreign(what) => throw TransportError.Foreign(from, what)
      ,
      _ => None
    ).filter(_.nonEmpty)

  /** All that a page may send without being allowed to by the answer to an OPTIONS, and what programs send.
    */
  private val Methods =
    Vector("GET", "POST", "HEAD", "PUT", "DELETE", "OPTIONS", "CONNECT", "TRACE", "PATCH", "PRI")
      .map(word => ByteString(s"$word ".getBytes(US_ASCII)))

  /** RFC 8446, 5.1: the type of a record of the handshake. */
  private val Handshake = 22
