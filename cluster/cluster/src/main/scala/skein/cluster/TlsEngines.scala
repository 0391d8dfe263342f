package skein.cluster

import javax.net.ssl.{SSLEngine, SSLException}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.remote.artery.tcp.ConfigSSLEngineProvider
import skein.link.TlsEngine

/** Makes TLS engines from Pekko's own settings for certificates. */
private[cluster] final class TlsEngines(system: ActorSystem) extends ConfigSSLEngineProvider(system):
  override def createServerSSLEngine(hostname: String, port: Int): SSLEngine =
    TlsEngine(super.createServerSSLEngine(hostname, port), told)
  override def createClientSSLEngine(hostname: String, port: Int): SSLEngine =
    TlsEngine(super.createClientSSLEngine(hostname, port), told)

  private def told(error: SSLException): Unit =
    system.eventStream.publish(CoordinatorBehavior.NotTrusted(s"${error.getMessage}"))
