package skein.cluster

import com.typesafe.config.{Config, ConfigFactory, ConfigUtil}
import java.io.IOException
import java.net.InetSocketAddress
import java.nio.file.{Files, Path}
import java.security.cert.X509Certificate
import java.security.{GeneralSecurityException, KeyStore}
import javax.net.ssl.{KeyManagerFactory, SSLContext, SSLException, SSLSocket, TrustManagerFactory}
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.link.{Address, TlsProbe, TransportError}

/** Certificates of a node: its own, and those that it trusts. Both sides present theirs, and host names are
  * verified.
  *
  * @param keyStore a PKCS #12 file with the node's key and certificate
  * @param trustStore a PKCS #12 file with the signer's certificate
  */
final case class Tls(keyStore: Path, trustStore: Path, password: String):

  /** A context for connections that Pekko does not make.
    *
    * @return Left says what is wrong with the files
    */
  def context: Either[String, SSLContext] =
    def store(file: Path) = KeyStore.getInstance(file.toFile, password.toCharArray)
    try
      val keys = KeyManagerFactory.getInstance(KeyManagerFactory.getDefaultAlgorithm)
      keys.init(store(keyStore), password.toCharArray)
      val trusted = TrustManagerFactory.getInstance(TrustManagerFactory.getDefaultAlgorithm)
      trusted.init(store(trustStore))
      val made = SSLContext.getInstance("TLSv1.3")
      made.init(keys.getKeyManagers, trusted.getTrustManagers, null)
      Right(made)
    catch
      case failed: (IOException | GeneralSecurityException) =>
        // Reading a truncated file fails without a message.
        Left(
          s"--tls: cannot read the certificates in ${keyStore.getParent}: " +
            Option(failed.getMessage).getOrElse("a file is damaged or cut off")
        )

  /** Checks that the node's own certificate is valid for this host, as the other nodes will.
    *
    * @return Left lists the names in it, or states what is wrong with the files
    */
  private[cluster] def shows(host: String): Either[String, Unit] =
    context.flatMap: _ =>
      val store = KeyStore.getInstance(keyStore.toFile, password.toCharArray)
      val own   = store.aliases.asScala
        .filter(store.isKeyEntry)
        .map(store.getCertificate)
        .collect { case certificate: X509Certificate => certificate }
        .toVector
      Either.cond(
        own.exists(ShownHosts.matches(_, host)),
        (),
        s"--tls: expected a certificate that shows $host, where this side listens; the one in " +
          s"${keyStore.getParent} shows ${own.flatMap(ShownHosts.of).mkString(", ")}"
      )

  /** The reason why no trusted connection to that endpoint can be made; None if certificates are not the
    * reason. Takes at most two seconds for each direction.
    */
  private[cluster] def refusal(at: Address): Option[String] =
    context.toOption.flatMap: made =>
      val tried = Using(made.getSocketFactory.createSocket().asInstanceOf[SSLSocket]): socket =>
        val parameters = socket.getSSLParameters
        parameters.setEndpointIdentificationAlgorithm("HTTPS")
        socket.setSSLParameters(parameters)
        socket.connect(InetSocketAddress(at.host, at.port), TlsProbe.Within.toMillis.toInt)
        socket.setSoTimeout(TlsProbe.Within.toMillis.toInt)
        socket.startHandshake()
        // In TLS 1.3 the peer verifies after the handshake has ended here.
        socket.getInputStream.read()
      tried.failed.toOption.collect:
        case reason: SSLException => TransportError.NotTrusted(at, reason).getMessage

  private[cluster] def config: Config =
    def quoted(text: Any) = ConfigUtil.quoteString(text.toString)
    ConfigFactory.parseString(s"""
      pekko.remote.artery {
        transport = tls-tcp
        ssl.ssl-engine-provider = "skein.cluster.TlsEngines"
        ssl.config-ssl-engine {
          key-store = ${quoted(keyStore.toAbsolutePath)}
          trust-store = ${quoted(trustStore.toAbsolutePath)}
          key-store-password = ${quoted(password)}
          key-password = ${quoted(password)}
          trust-store-password = ${quoted(password)}
          protocol = "TLSv1.3"
          enabled-algorithms = [TLS_AES_256_GCM_SHA384, TLS_AES_128_GCM_SHA256]
          require-mutual-authentication = on
          hostname-verification = on
        }
      }
    """)

object Tls:
  val KeyStore   = "node.p12"
  val TrustStore = "trust.p12"
  val Password   = "password"

  /** Reads a folder with `node.p12`, `trust.p12` and `password`.
    *
    * @return Left says what is missing
    */
  def of(folder: Path): Either[String, Tls] =
    val missing =
      Vector(KeyStore, TrustStore, Password).filterNot(name => Files.isReadable(folder.resolve(name)))
    if missing.nonEmpty then
      Left(
        s"--tls: expected $KeyStore, $TrustStore and $Password in " +
          s"$folder, cannot read ${missing.mkString(", ")}"
      )
    else
      try
        val password = Files.readString(folder.resolve(Password)).trim
        Right(Tls(folder.resolve(KeyStore), folder.resolve(TrustStore), password))
      catch
        case failed: IOException =>
          Left(s"--tls: cannot read ${folder.resolve(Password)}: ${failed.getMessage}")
