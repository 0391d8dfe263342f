package skein.kafka

import java.util.Properties
import java.util.concurrent.{ExecutionException, TimeUnit}
import org.apache.kafka.clients.admin.{Admin, NewTopic}
import org.apache.kafka.common.errors.{
  AuthenticationException,
  AuthorizationException,
  SslAuthenticationException,
  TopicExistsException
}
import scala.jdk.CollectionConverters.*
import scala.util.Using
import scala.util.control.NonFatal
import skein.link.Address

/** The two topics between flights and a solver, one partition each, so that messages keep their order.
  *
  * @param prefix prefix of the topics' names
  * @param security Kafka's own settings of clients: `security.protocol`, `ssl.…`, `sasl.…`; passwords among
  *   them are shown nowhere
  */
final case class KafkaTopics(broker: Address, prefix: String)(val security: Map[String, String] = Map.empty):
  def questions: String = s"$prefix.questions"
  def answers: String   = s"$prefix.answers"

  /** Creates missing topics. Blocks for some seconds at most.
    *
    * @return Left says why the broker cannot be used
    */
  private[kafka] def made(): Either[KafkaTopics.Absent, Unit] =
    val settings =
      KafkaTopics.settings(this)("default.api.timeout.ms" -> "5000", "request.timeout.ms" -> "2000")
    try
      Using.resource(Admin.create(settings)): admin =>
        for name <- Seq(questions, answers) do
          val short = Map("retention.ms" -> "600000", "segment.bytes" -> "16777216").asJava
          val topic = NewTopic(name, 1, 1.toShort).configs(short)
          // Longer than Kafka's own time-out, whose error states what it waited for.
          try admin.createTopics(java.util.List.of(topic)).all.get(8, TimeUnit.SECONDS): Unit
          catch case exists: ExecutionException if exists.getCause.isInstanceOf[TopicExistsException] => ()
      Right(())
    catch
      case NonFatal(error) => Left(KafkaTopics.Absent.of(this, error))

object KafkaTopics:

  /** A broker cannot be used.
    *
    * @param isFinal whether it was reachable and refused, so that retries do not help
    */
  private[kafka] final case class Absent(reason: String, isFinal: Boolean)

  private[kafka] object Absent:
    def of(topics: KafkaTopics, error: Throwable): Absent =
      val at = topics.broker
      causes(error).collectFirst {
        case _: SslAuthenticationException =>
          s"no trusted connection to the Kafka broker at $at: ${rootOf(error)}; " +
            "expected certificates of one set at both sides, which name the host"
        case _: AuthenticationException | _: AuthorizationException =>
          s"the Kafka broker at $at refuses: ${rootOf(error)}"
      } match
        case Some(reason) => Absent(reason, isFinal = true)
        case None         =>
          val plain = if topics.security.isEmpty then "; does one listen there, without TLS?" else ""
          Absent(s"no Kafka broker at $at: ${rootOf(error)}$plain", isFinal = false)

  private[kafka] def causes(error: Throwable): Iterator[Throwable] =
    Iterator.iterate(error)(_.getCause).takeWhile(_ != null)

  private[kafka] def rootOf(error: Throwable): String =
    val root = causes(error).toVector.last
    Option(root.getMessage).getOrElse(root.toString)

  /** A client's settings: it reconnects soon after a broker is back. */
  private[kafka] def settings(topics: KafkaTopics)(own: (String, String)*): Properties =
    val settings = Properties()
    for
      (key, value) <- topics.security.toSeq ++ own ++ Seq(
        "bootstrap.servers"                  -> topics.broker.toString,
        "reconnect.backoff.ms"               -> "50",
        "reconnect.backoff.max.ms"           -> "250",
        "retry.backoff.ms"                   -> "50",
        "retry.backoff.max.ms"               -> "250",
        "socket.connection.setup.timeout.ms" -> "1000",
        "metadata.recovery.strategy"         -> "rebootstrap"
      )
    do settings.put(key, value)
    settings
