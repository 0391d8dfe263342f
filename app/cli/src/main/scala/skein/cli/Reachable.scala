package skein.cli

import java.net.InetAddress
import scala.util.Try
import skein.link.Address

private[cli] object Reachable:
  /** Where this machine reaches what listens at an address, by number: on loopback what listens on all of the
    * machine's addresses. None if the host is not known.
    */
  def from(listening: Address): Option[Address] =
    Try(InetAddress.getByName(listening.host)).toOption.map: host =>
      Address(if host.isAnyLocalAddress then "127.0.0.1" else host.getHostAddress, listening.port)
