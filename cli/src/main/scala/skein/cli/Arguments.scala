package skein.cli

import skein.link.Address
import skein.settings.{ConfigKeys, TextFile}
import skein.signal.LatencyProfile

/** What several commands read from their options. */
private[cli] object Arguments:

  /** `HOST:PORT`. */
  def address(text: String): Either[String, Address] =
    text.split(':') match
      case Array(host, port) if host.nonEmpty && port.toIntOption.exists(p => p >= 0 && p <= 65535) =>
        Right(Address(host, port.toInt))
      case _ => Left(s"expected HOST:PORT, for example 127.0.0.1:41451, came '$text'")

  /** Settings of a scenario, `NAME=VALUE` each, by their keys; or every mistake. */
  def settings(texts: Seq[String]): Either[String, Seq[(String, String)]] =
    all(texts): text =>
      text.split("=", 2) match
        case Array(name, value) if name.nonEmpty => Right(ConfigKeys.ofField(name) -> value)
        case _ => Left(s"--set: expected NAME=VALUE, for example vehicles=8, came '$text'")

  /** All, or every mistake. */
  def all[A, B](each: Seq[A])(read: A => Either[String, B]): Either[String, Seq[B]] =
    val (wrong, right) = each.map(read).partitionMap(identity)
    Either.cond(wrong.isEmpty, right, wrong.mkString("\n"))

  def latency(text: String): Either[String, LatencyProfile] =
    LatencyProfile.parse(text, TextFile.read).left.map(_.message)
