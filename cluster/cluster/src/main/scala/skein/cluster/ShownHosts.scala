package skein.cluster

import java.net.InetAddress
import java.security.cert.X509Certificate
import java.util.Locale
import javax.naming.ldap.LdapName
import scala.jdk.CollectionConverters.*
import scala.util.Try

/** The hosts in a certificate, against which the JDK's TLS verifies a host (RFC 6125, 6.4): an address
  * against the certificate's addresses; a name against its names or, if it has none, the subject's name.
  */
private[cluster] object ShownHosts:
  // RFC 5280, 4.2.1.6, GeneralName.
  private val Name    = 2
  private val Address = 7

  def matches(certificate: X509Certificate, host: String): Boolean = address(host) match
    case Some(wanted) => alternatives(certificate, Address).flatMap(address).contains(wanted)
    case None         => names(certificate).exists(covers(_, host))

  def of(certificate: X509Certificate): Vector[String] =
    names(certificate) ++ alternatives(certificate, Address)

  private def names(certificate: X509Certificate): Vector[String] =
    Some(alternatives(certificate, Name)).filter(_.nonEmpty).getOrElse:
      val subject = LdapName(certificate.getSubjectX500Principal.getName)
      subject.getRdns.asScala.filter(_.getType.equalsIgnoreCase("CN")).map(_.getValue.toString).toVector

  private def alternatives(certificate: X509Certificate, kind: Int): Vector[String] =
    Option(certificate.getSubjectAlternativeNames).toVector
      .flatMap(_.asScala)
      .filter(_.get(0) == kind)
      .map(_.get(1).toString)

  private def address(text: String): Option[InetAddress] = Try(InetAddress.ofLiteral(text)).toOption

  /** Whether a certificate's name matches a host; a star stands for part of one label. */
  private def covers(shown: String, host: String): Boolean =
    val (ours, theirs) = (shown.toLowerCase(Locale.ROOT).split('.'), host.toLowerCase(Locale.ROOT).split('.'))
    ours.length == theirs.length && ours.zip(theirs).forall: (part, of) =>
      val (before, after) = part.span(_ != '*')
      if after.isEmpty then part == of
      else
        of.length >= part.length - 1 && of.startsWith(before) && of.endsWith(after.drop(1))
