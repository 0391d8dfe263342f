package skein.kafka

import java.io.{OutputStream, PrintStream}
import java.net.{BindException, InetAddress, ServerSocket}
import java.nio.file.{Files, Path}
import java.util.{Comparator, Properties}
import kafka.server.{KafkaConfig, KafkaRaftServer}
import org.apache.kafka.common.Uuid
import org.apache.kafka.common.utils.{Exit, Time}
import org.apache.kafka.metadata.storage.Formatter
import scala.jdk.CollectionConverters.*
import scala.util.Using
import scala.util.control.NonFatal
import skein.link.Address

/** Kafka's own broker in this process, one node that is its own controller. Its data is in a folder. One that
  * fails at run time stops answering, and states why on standard error; Kafka itself would end the process.
  */
final class KafkaBroker private (server: KafkaRaftServer, val address: Address) extends AutoCloseable:

  def close(): Unit =
    server.shutdown()
    server.awaitShutdown()

object KafkaBroker:

  /** Blocks until it answers.
    *
    * @param folder holds the broker's data; data of an earlier broker is continued
    * @param at the broker's address, which it advertises to clients; port 0 takes a free one
    * @param certificates settings by [[KafkaCertificates]]: it presents its own certificate, and requests
    *   those of clients. Without them it accepts every client
    * @return Left says why it cannot start
    */
  def start(
      folder: Path,
      at: Address,
      certificates: Map[String, String] = Map.empty
  ): Either[String, KafkaBroker] =
    start(folder, at, certificates, freed, Attempts)

  /** Starts a broker.
    *
    * @param free finds a free port if none is given
    * @param attempts number of tries: another program may take a free port before the broker listens there
    */
  private[kafka] def start(
      folder: Path,
      at: Address,
      certificates: Map[String, String],
      free: Address => Int,
      attempts: Int
  ): Either[String, KafkaBroker] =
    outlive()
    try
      val own = at.copy(port = free(at))
      if !Files.exists(folder.resolve("meta.properties")) then format(folder)
      try Right(KafkaBroker(started(configuration(folder, own, free(Address(Inside, 0)), certificates)), own))
      catch
        case NonFatal(error)
            if attempts > 1 && KafkaTopics.causes(error).exists(_.isInstanceOf[BindException]) =>
          start(folder, at, certificates, free, attempts - 1)
    catch
      case NonFatal(error) =>
        Left(s"cannot start a broker at $at: ${KafkaTopics.rootOf(error)}")

  private def started(configuration: Map[String, String]): KafkaRaftServer =
    val settings = Properties()
    settings.putAll(configuration.asJava)
    val server = KafkaRaftServer(KafkaConfig.fromProps(settings, false), Time.SYSTEM)
    try
      server.startup()
      server
    catch
      case NonFatal(error) =>
        server.shutdown()
        throw error

  private val Attempts = 3

  /** Prevents Kafka from ending the process at a fault, at the start of a broker and later. Its code after
    * that call throws or does nothing.
    */
  private def outlive(): Unit =
    val told: Exit.Procedure = (code, message) =>
      val why = Option(message).fold("")(": " + _)
      System.err.println(s"the Kafka broker in this process has failed, with code $code$why")
    Exit.setExitProcedure(told)
    Exit.setHaltProcedure(told)

  /** Deletes the data of a broker that has ended. */
  def delete(folder: Path): Unit =
    if Files.exists(folder) then
      Using.resource(
        Files.walk(folder)
      )(_.sorted(Comparator.reverseOrder).forEach(Files.deleteIfExists(_): Unit))

  /** Address at which it connects to itself as its controller. */
  private val Inside = "127.0.0.1"

  private[kafka] def freed(at: Address): Int =
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

  /** Minimal settings of one node: every internal topic has one partition, and starts without waiting for
    * other nodes.
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
