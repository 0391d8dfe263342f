package skein.link

import org.apache.pekko.stream.scaladsl.{Flow, Source}
import org.apache.pekko.util.ByteString
import org.apache.pekko.{Done, NotUsed}
import scala.concurrent.Future

/** A host and port. */
final case class Address(host: String, port: Int):
  override def toString: String = s"$host:$port"

/** Where connections come from: TCP in live flight, the in-memory network in virtual time. Everything above
  * it works on byte streams and is the same for both.
  */
trait Transport:

  /** One outgoing connection per materialisation. The future completes when connected, or fails with the
    * reason.
    */
  def connect(to: Address): Flow[ByteString, ByteString, Future[Done]]

  /** Incoming connections. The future completes when bound, or fails (port taken). Port 0 takes a free one.
    */
  def listen(at: Address): Source[Incoming, Future[Listening]]

/** One accepted connection; its flow must be materialised exactly once. */
final case class Incoming(from: Address, flow: Flow[ByteString, ByteString, NotUsed])

/** A port that accepts connections until it is closed. */
trait Listening:
  /** Where it listens, with the actual port. */
  def address: Address

  /** Accepts no more; connections already open go on. */
  def close(): Future[Done]
