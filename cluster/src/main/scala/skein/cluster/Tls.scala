package skein.cluster

import com.typesafe.config.{Config, ConfigFactory, ConfigUtil}
import java.io.IOException
import java.nio.file.{Files, Path}
import java.security.{GeneralSecurityException, KeyStore}
import javax.net.ssl.{KeyManagerFactory, SSLContext, TrustManagerFactory}

/** Certificates of a node: its own, and those that it trusts. Both sides show theirs, and hosts' names are
  * verified.
  *
  * @param keyStore PKCS #12, with the node's key and certificate
  * @param trustStore PKCS #12, with the certificate of whoever signs
  */
final case class Tls(keyStore: Path, trustStore: Path, password: String):

  /** For connections that are not Pekko's own: who shows what, and whom it trusts.
    *
    * @return or what is wrong with the files
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
        Left(s"--tls: cannot read the certificates in ${keyStore.getParent}: ${failed.getMessage}")

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
    * @return or what is missing
    */
  def of(folder: Path): Either[String, Tls] =
    val missing =
      Vector(KeyStore, TrustStore, Password).filterNot(name => Files.isReadable(folder.resolve(name)))
    Either.cond(
      missing.isEmpty,
      Tls(
        folder.resolve(KeyStore),
        folder.resolve(TrustStore),
        Files.readString(folder.resolve(Password)).trim
      ),
      s"--tls: expected $KeyStore, $TrustStore and $Password in " +
        s"$folder, cannot read ${missing.mkString(", ")}"
    )
