package skein.cli

import java.net.InetAddress
import scala.util.Try
import skein.link.Address

private[cli] object Reachable:
  /** The numeric address by which this machine reaches a server that listens at `listening`: 127.0.0.1 if it
    * listens on all interfaces. None if the host is not known.
    */
  def from(listening: Address): Option[Address] =
    Try(InetAddress.getByName(listening.host)).toOption.map: host =>
      Address(if host.isAnyLocalAddress then "127.0.0.1" else host.getHostAddress, listening.port)
