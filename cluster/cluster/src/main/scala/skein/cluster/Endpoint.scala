package skein.cluster

import java.net.InetAddress
import scala.util.Try
import skein.link.Address

/** Where a node listens. */
final case class Endpoint(host: String, port: Int):
  override def toString: String = Address(host, port).toString

  private[cluster] def uriHost: String = Address(host, port).uriHost

  /** Whether only this machine can reach it. */
  def isLoopback: Boolean = Try(InetAddress.getByName(host).isLoopbackAddress).getOrElse(false)
