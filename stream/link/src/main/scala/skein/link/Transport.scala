package skein.link

import java.net.InetAddress
import org.apache.pekko.stream.scaladsl.{Flow, Source}
import org.apache.pekko.util.ByteString
import org.apache.pekko.{Done, NotUsed}
import scala.concurrent.Future
import scala.util.Try

/** A host and port.
  *
  * @param host a host name, or an address; IPv6 without brackets
  */
final case class Address(host: String, port: Int):
  override def toString: String = s"$uriHost:$port"

  /** The host in a URI's form: an IPv6 address in brackets. */
  def uriHost: String = if host.contains(':') then s"[$host]" else host

  /** Whether it is reachable only from this machine. */
  def isLoopback: Boolean = Try(InetAddress.getByName(host).isLoopbackAddress).getOrElse(false)

object Address:
  private val Plain = raw"([^:\[\]]+):(\d{1,5})".r
  private val IPv6  = raw"\[([^\[\]]*:[^\[\]]*)\]:(\d{1,5})".r

  /** Parses `HOST:PORT`, or for an IPv6 address `[ADDRESS]:PORT`.
    *
    * @return Left says what was expected and what was given
    */
  def parse(text: String): Either[String, Address] = text match
    case Plain(_, port) if port.toInt > MostPort => Left(s"expected a port up to $MostPort, got '$text'")
    case IPv6(_, port) if port.toInt > MostPort  => Left(s"expected a port up to $MostPort, got '$text'")
    case Plain(host, port)                       => Right(Address(host, port.toInt))
    case IPv6(host, port) if Try(InetAddress.ofLiteral(host)).isSuccess => Right(Address(host, port.toInt))
    case _                                                              =>
      val example = if text.count(_ == ':') > 1 then "[::1]:41451 of an IPv6 address" else "127.0.0.1:41451"
      Left(s"expected HOST:PORT, for example $example, got '$text'")

  private val MostPort = 65535

/** Opens connections: TCP in live flight, the in-memory network in virtual time. The code above works on byte
  * streams and does not depend on the transport.
  */
trait Transport:

  /** One outgoing connection per materialisation. The future completes when connected, or fails with the
    * reason.
    */
  def connect(to: Address): Flow[ByteString, ByteString, Future[Done]]

  /** Incoming connections. The future completes when the port is bound, or fails (port taken). Port 0 takes a
    * free port.
    */
  def listen(at: Address): Source[Incoming, Future[Listening]]

/** One accepted connection; its flow must be materialised exactly once. */
final case class Incoming(from: Address, flow: Flow[ByteString, ByteString, NotUsed])

/** A port that accepts connections until it is closed. */
trait Listening:
  /** The listening address, with the actual port. */
  def address: Address

  /** Stops accepting; open connections stay open. */
  def close(): Future[Done]
