package skein.view

import com.typesafe.config.ConfigFactory
import org.apache.pekko.actor.{ActorSystem, BootstrapSetup}
import scala.concurrent.ExecutionContext

/** An actor system for a small HTTP server, with bounds for its clients. */
object HttpSystem:

  /** @param threads the only threads that it uses
    * @param more further settings of `pekko.http.server`
    */
  def apply(name: String, threads: ExecutionContext, more: String): ActorSystem =
    val bounds = ConfigFactory.parseString(more).atPath("pekko.http.server")
    ActorSystem(name, BootstrapSetup(None, Some(bounds.withFallback(common)), Some(threads)))

  private def common = ConfigFactory
    .parseString("""
      |pekko.http.server {
      |  idle-timeout = 60s
      |  linger-timeout = 1s
      |  pipelining-limit = 1
      |  server-header = ""
      |  parsing.max-content-length = 4k
      |  parsing.max-header-count = 64
      |  # Headers come as they were sent, also those that nobody can parse: Access compares texts.
      |  parsing.modeled-header-parsing = off
      |}
      |pekko.actor.internal-dispatcher = pekko.actor.default-dispatcher
      |pekko.coordinated-shutdown.run-by-jvm-shutdown-hook = off
      |# Nobody who connects can fill a terminal.
      |pekko.loglevel = OFF
      |pekko.stdout-loglevel = OFF
      |""".stripMargin)
    .withFallback(ConfigFactory.load())
