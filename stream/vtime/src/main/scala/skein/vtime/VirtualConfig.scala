package skein.vtime

import com.typesafe.config.{Config, ConfigFactory, ConfigObject, ConfigUtil}
import scala.jdk.CollectionConverters.*

/** Changes a configuration so that its actor system runs on the loop. */
private object VirtualConfig:

  /** Makes every dispatcher in `config` run on the loop; those that need threads, and sockets, are refused.
    */
  def apply(config: Config): Config =
    val (of, made) = latest
    if of eq config then made
    else
      val changed = change(config)
      latest = (config, changed)
      changed

  // Most runs have the same configuration, and this takes as long as a second of a flight.
  @volatile private var latest = (ConfigFactory.empty, ConfigFactory.empty)

  private def change(config: Config): Config =
    val overrides = dispatchers(config.root, Nil).map: (path, kind) =>
      if kind == "PinnedDispatcher" then s"${ConfigUtil.joinPath((path :+ "type").asJava)} = $refused"
      else s"${ConfigUtil.joinPath((path :+ "executor").asJava)} = $loopExecutor"
    ConfigFactory.parseString((overrides :+ fixed).mkString("\n")).withFallback(config).resolve()

  private val refused      = s"\"${classOf[RefusedDispatcher].getName}\""
  private val loopExecutor = s"\"${classOf[LoopExecutorConfigurator].getName}\""

  private val fixed = s"""
    pekko.scheduler.implementation = "${classOf[LoopScheduler].getName}"
    pekko.jvm-shutdown-hooks = off
    pekko.jvm-exit-on-fatal-error = off
    pekko.coordinated-shutdown { run-by-jvm-shutdown-hook = off, exit-jvm = off, log-info = off }
    ${RefusedDispatcher.sockets} { type = $refused }
    pekko.io.tcp.management-dispatcher = "${RefusedDispatcher.sockets}"
    pekko.io.udp.management-dispatcher = "${RefusedDispatcher.sockets}"
    pekko.io.udp-connected.management-dispatcher = "${RefusedDispatcher.sockets}"
    pekko.io.dns.dispatcher = "${RefusedDispatcher.sockets}"
    """

  /** Path and `type` of each dispatcher in the configuration. */
  private def dispatchers(at: ConfigObject, path: Seq[String]): Seq[(Seq[String], String)] =
    val here = Option(at.get("type")).map(_.unwrapped).collect:
      case kind @ ("Dispatcher" | "PinnedDispatcher") => (path, kind.toString)
    here.toSeq ++ at.asScala.toSeq.sortBy(_._1).flatMap:
      case (key, child: ConfigObject) => dispatchers(child, path :+ key)
      case _                          => Nil
