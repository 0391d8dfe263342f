package skein.kafka

import java.io.{IOException, OutputStream, PrintStream}
import java.net.{InetAddress, ServerSocket}
import java.nio.file.{Files, Path}
import java.util.{Comparator, Properties}
import kafka.server.{KafkaConfig, KafkaRaftServer}
import org.apache.kafka.common.Uuid
import org.apache.kafka.common.utils.Time
import org.apache.kafka.metadata.storage.Formatter
import scala.jdk.CollectionConverters.*
import scala.util.Using
import scala.util.control.NonFatal
import skein.link.Address

/** Kafka's own broker in this process, one node that is its own controller: for tests, and for the first try. On this
  * machine's loopback alone; what it holds lies in a folder.
  */
final class KafkaBroker private (server: KafkaRaftServer, val address: Address) extends AutoCloseable:

  /** Blocks until it has ended. */
  def close(): Unit =
    server.shutdown()
    server.awaitShutdown()

object KafkaBroker:

  /** Blocks until it answers.
    *
    * @param folder
    *   for what it holds; one that a broker of before has left goes on
    * @param port
    *   0 takes a free one
    * @return
    *   or why it cannot be had
    */
  def start(folder: Path, port: Int): Either[String, KafkaBroker] =
    try
      val (own, controllers) = (freed(port), freed(0))
      val settings           = Properties()
      settings.putAll(configuration(folder, own, controllers).asJava)
      if !Files.exists(folder.resolve("meta.properties")) then format(folder)
      val server = KafkaRaftServer(KafkaConfig.fromProps(settings, false), Time.SYSTEM)
      server.startup()
      Right(KafkaBroker(server, Address(Host, own)))
    catch
      case NonFatal(error) =>
        val why = Iterator.iterate[Throwable](error)(_.getCause).takeWhile(_ != null).toVector.last
        Left(s"cannot start a broker at $Host:$port: ${Option(why.getMessage).getOrElse(why.toString)}")

  /** Takes away what a broker that has ended held. */
  def delete(folder: Path): Unit =
    if Files.exists(folder) then
      Using.resource(
        Files.walk(folder)
      )(_.sorted(Comparator.reverseOrder).forEach(Files.deleteIfExists(_): Unit))

  private val Host = "127.0.0.1"

  private def freed(port: Int): Int =
    try Using.resource(ServerSocket(port, 1, InetAddress.getByName(Host)))(_.getLocalPort)
    catch case _: IOException => throw IOException(s"port $port is taken")

  private def format(folder: Path): Unit =
    Formatter()
      .setPrintStream(PrintStream(OutputStream.nullOutputStream))
      .setNodeId(1)
      .setClusterId(Uuid.randomUuid.toString)
      .setControllerListenerName("CONTROLLER")
      .setMetadataLogDirectory(folder.toString)
      .addDirectory(folder.toString)
      .run()

  /** As little as one node needs: every topic of internal use has one partition, and starts without waiting for others. */
  private def configuration(folder: Path, port: Int, controllers: Int): Map[String, String] = Map(
    "process.roles"                            -> "broker,controller",
    "node.id"                                  -> "1",
    "listeners"                                -> s"PLAINTEXT://$Host:$port,CONTROLLER://$Host:$controllers",
    "advertised.listeners"                     -> s"PLAINTEXT://$Host:$port",
    "controller.listener.names"                -> "CONTROLLER",
    "listener.security.protocol.map"           -> "PLAINTEXT:PLAINTEXT,CONTROLLER:PLAINTEXT",
    "controller.quorum.voters"                 -> s"1@$Host:$controllers",
    "log.dirs"                                 -> folder.toString,
    "auto.create.topics.enable"                -> "false",
    "offsets.topic.replication.factor"         -> "1",
    "offsets.topic.num.partitions"             -> "1",
    "transaction.state.log.replication.factor" -> "1",
    "transaction.state.log.min.isr"            -> "1",
    "group.initial.rebalance.delay.ms"         -> "0",
    "num.network.threads"                      -> "1",
    "num.io.threads"                           -> "2",
    "background.threads"                       -> "1",
    "log.cleaner.enable"                       -> "false",
    "controlled.shutdown.enable"               -> "false"
  )
