package skein.kafka

import java.nio.file.Path

/** Certificates for Kafka's clients and brokers: TLS 1.3 only, and a host must be named in its certificate.
  */
object KafkaCertificates:

  /** The TLS settings of a client or broker.
    *
    * @param keyStore PKCS #12, with this side's key and certificate, which a broker may request from clients
    * @param trustStore PKCS #12, with the certificate of the authority
    * @param password the password of both stores and of the key
    * @return `security.protocol` and `ssl.…` of Kafka's configuration
    */
  def settings(keyStore: Path, trustStore: Path, password: String): Map[String, String] = Map(
    Protocol                                -> "SSL",
    "ssl.protocol"                          -> "TLSv1.3",
    "ssl.enabled.protocols"                 -> "TLSv1.3",
    "ssl.endpoint.identification.algorithm" -> "https",
    "ssl.keystore.type"                     -> "PKCS12",
    "ssl.keystore.location"                 -> keyStore.toAbsolutePath.toString,
    "ssl.keystore.password"                 -> password,
    "ssl.key.password"                      -> password,
    "ssl.truststore.type"                   -> "PKCS12",
    "ssl.truststore.location"               -> trustStore.toAbsolutePath.toString,
    "ssl.truststore.password"               -> password
  )

  private[kafka] val Protocol = "security.protocol"
