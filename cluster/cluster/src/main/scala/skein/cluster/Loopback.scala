package skein.cluster

import java.net.InetAddress
import scala.util.Try
import skein.link.Address

/** Whether an address is reachable only from this machine. */
extension (at: Address)
  def isLoopback: Boolean = Try(InetAddress.getByName(at.host).isLoopbackAddress).getOrElse(false)
