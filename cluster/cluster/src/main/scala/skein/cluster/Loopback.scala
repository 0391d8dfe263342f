package skein.cluster

import java.net.InetAddress
import scala.util.Try
import skein.link.Address

extension (at: Address)
  /** Whether it is reachable only from this machine. */
  def isLoopback: Boolean = Try(InetAddress.getByName(at.host).isLoopbackAddress).getOrElse(false)
