package skein.cli

import scala.concurrent.duration.{Duration, FiniteDuration}
import scala.util.Try
import skein.experiment.TextFile
import skein.link.Address
import skein.signal.LatencyProfile
import skein.units.Span

/** What several commands read from their options. */
private[cli] object Arguments:

  /** `HOST:PORT`. */
  def address(text: String): Either[String, Address] =
    text.split(':') match
      case Array(host, port) if host.nonEmpty && port.toIntOption.exists(p => p >= 0 && p <= 65535) =>
        Right(Address(host, port.toInt))
      case _ => Left(s"expected HOST:PORT, for example 127.0.0.1:41451, came '$text'")

  /** A length of time such as `100ms`. */
  def span(text: String): Either[String, Span] =
    Try(Duration(text)).toOption
      .collect { case finite: FiniteDuration if finite >= Duration.Zero => Span.ofNanos(finite.toNanos) }
      .toRight(s"expected a length of time, for example 100ms, came '$text'")

  def latency(text: String): Either[String, LatencyProfile] =
    LatencyProfile.parse(text, TextFile.read).left.map(_.message)
