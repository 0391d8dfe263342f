package skein.cli

import skein.link.Address
import skein.settings.TextFile
import skein.signal.LatencyProfile

/** What several commands read from their options. */
private[cli] object Arguments:

  /** `HOST:PORT`. */
  def address(text: String): Either[String, Address] =
    text.split(':') match
      case Array(host, port) if host.nonEmpty && port.toIntOption.exists(p => p >= 0 && p <= 65535) =>
        Right(Address(host, port.toInt))
      case _ => Left(s"expected HOST:PORT, for example 127.0.0.1:41451, came '$text'")

  def latency(text: String): Either[String, LatencyProfile] =
    LatencyProfile.parse(text, TextFile.read).left.map(_.message)
