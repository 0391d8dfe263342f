package skein.link

import java.nio.charset.StandardCharsets.US_ASCII
import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.{Flow, Source}
import org.apache.pekko.util.ByteString

/** Recognises the protocol of a new connection's peer by its first bytes. A browser opens connections to any
  * port for any page; its data begin as HTTP or TLS, followed by bytes of the page's choice. Such a
  * connection is closed before any of its data are obeyed.
  */
enum FirstBytes:
  /** The bytes fit the port's own protocol: the rest may be read. */
  case Own

  /** The bytes so far could begin an HTTP request: the next bytes decide, and until then none may be acted
    * on.
    */
  case Undecided

  /** @param what a description for the user: "got …" */
  case Foreign(what: String)

object FirstBytes:
  /** Recognises the protocol. Pure; while the result is [[Undecided]], call it again with all bytes so far.
    *
    * @param bytes the connection's bytes, from its beginning
    * @param own the first bytes of the port's protocol, 0 to 255; empty: any that do not begin another
    *   protocol
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
        case _ if own.nonEmpty && !own(first & 0xff)     =>
          Foreign(s"a first byte of 0x${Integer.toHexString(first & 0xff | 0x100).drop(1)}")
        case _ => Own

  /** Passes a connection's bytes on once the first ones fit the port's own protocol.
    *
    *   - '''Emits when''' bytes arrive and the protocol is decided, or upstream has completed before it is.
    *   - '''Backpressures when''' downstream does.
    *   - '''Completes when''' upstream has completed.
    *   - '''Fails when''' the first bytes are foreign, with [[TransportError.Foreign]].
    *   - '''Cancels when''' downstream cancels, or it fails.
    */
  def guard(from: Address, own: Set[Int] = Set.empty): Flow[ByteString, ByteString, NotUsed] =
    val whole = Flow[ByteString].map(Option(_)).concatLazy(Source.single(None))
    // No bytes kept: decided.
    whole.statefulMap(() => Option(ByteString.empty))(
      {
        case (None, bytes)              => (None, bytes.getOrElse(ByteString.empty))
        case (Some(before), None)       => (None, before) // no more follow, so that these are no request
        case (Some(before), Some(next)) =>
          val all = before ++ next
          verdict(all, own) match
            case Own           => (None, all)
            case Undecided     => (Some(all), ByteString.empty)
            case Foreign(what) => throw TransportError.Foreign(from, what)
      },
      _ => None
    ).filter(_.nonEmpty)

  /** HTTP methods that a page may send without a prior OPTIONS request, and methods that programs send. */
  private val Methods =
    Vector("GET", "POST", "HEAD", "PUT", "DELETE", "OPTIONS", "CONNECT", "TRACE", "PATCH", "PRI")
      .map(word => ByteString(s"$word ".getBytes(US_ASCII)))

  /** The record type of a TLS handshake: RFC 8446, 5.1. */
  private val Handshake = 22
