package skein.cluster

import java.net.InetAddress
import scala.util.Try

/** Where a node listens. */
final case class Endpoint(host: String, port: Int):
  override def toString: String = s"$host:$port"

  /** Whether nobody from another machine gets there. */
  def isLoopback: Boolean = Try(InetAddress.getByName(host).isLoopbackAddress).getOrElse(false)
