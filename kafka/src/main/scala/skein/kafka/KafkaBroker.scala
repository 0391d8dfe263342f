package skein.kafka

import java.io.{OutputStream, PrintStream}
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

/** Kafka's own broker in this process, one node that is its own controller: for tests, and for labs that have
  * no other. What it holds lies in a folder.
  */
final class KafkaBroker private (server: KafkaRaftServer, val address: Address) extends AutoCloseable:

  /** Blocks until it has ended. */
  def close(): Unit =
    server.shutdown()
    server.awaitShutdown()

object KafkaBroker:

  /** Blocks until it answers.
    *
    * @param folder for what it holds; one that a broker of before has left goes on
    * @param at where clients find it, which it tells them; port 0 takes a free one
    * @param certificates of [[KafkaCertificates]]: it shows its own, and asks clients for theirs. Without
    *   them it speaks to everybody who gets there
    * @return or why it cannot be had
    */
  def start(
      folder: Path,
      at: Address,
      certificates: Map[String, String] = Map.empty
  ): Either[String, KafkaBroker] =
    try
      val own         = at.copy(port = freed(at))
      val controllers = freed(Address(Inside, 0))
      val settings    = Properties()
      settings.putAll(configuration(folder, own, controllers, certificates).asJava)
      if !Files.exists(folder.resolve("meta.properties")) then format(folder)
      val server = KafkaRaftServer(KafkaConfig.fromProps(settings, false), Time.SYSTEM)
      server.startup()
      Right(KafkaBroker(server, own))
    catch
      case NonFatal(error) =>
        Left(s"cannot start a broker at $at: ${KafkaTopics.rootOf(error)}")

  /** Takes away what a broker that has ended held. */
  def delete(folder: Path): Unit =
    if Files.exists(folder) then
      Using.resource(
        Files.walk(folder)
      )(_.sorted(Comparator.reverseOrder).forEach(Files.deleteIfExists(_): Unit))

  /** Where it speaks to itself as its controller. */
  private val Inside = "127.0.0.1"

  private def freed(at: Address): Int =
    Using.resource(ServerSocket(at.port, 1, InetAddress.getByName(at.host)))(_.getLocalPort)

  private def format(folder: Path): Unit =
    Formatter()
      .setPrintStream(PrintStream(OutputStream.nullOutputStream))
      .setNodeId(1)
      .setClusterId(Uuid.randomUuid.toString)
      .setControllerListenerName("CONTROLLER")
      .setMetadataLogDirectory(folder.toString)
      .addDirectory(folder.toString)
      .run()

  /** As little as one node needs: every topic of internal use has one partition, and starts without waiting
    * for others.
    */
  private def configuration(
      folder: Path,
      at: Address,
      controllers: Int,
      certificates: Map[String, String]
  ): Map[String, String] = certificates.removed(KafkaCertificates.Protocol) ++ Map(
    "process.roles"                  -> "broker,controller",
    "node.id"                        -> "1",
    "listeners"                      -> s"CLIENTS://$at,CONTROLLER://$Inside:$controllers",
    "advertised.listeners"           -> s"CLIENTS://$at",
    "inter.broker.listener.name"     -> "CLIENTS",
    "controller.listener.names"      -> "CONTROLLER",
    "listener.security.protocol.map" ->
      s"CLIENTS:${certificates.getOrElse(KafkaCertificates.Protocol, "PLAINTEXT")},CONTROLLER:PLAINTEXT",
    "ssl.client.auth"                          -> "required",
    "controller.quorum.voters"                 -> s"1@$Inside:$controllers",
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
