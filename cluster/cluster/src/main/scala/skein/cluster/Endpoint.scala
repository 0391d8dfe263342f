package skein.cluster

import java.net.InetAddress
import scala.util.Try
import skein.link.Address

/** Host and port at which a node listens. */
final case class Endpoint(host: String, port: Int):
  override def toString: String = Address(host, port).toString

  private[cluster] def uriHost: String = Address(host, port).uriHost

  /** Whether the endpoint is reachable only from this machine. */
  def isLoopback: Boolean = Try(InetAddress.getByName(host).isLoopbackAddress).getOrElse(false)
