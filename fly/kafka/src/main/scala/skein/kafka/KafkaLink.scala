package skein.kafka

import java.util.concurrent.atomic.AtomicReference
import org.apache.pekko.Done
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Success}
import skein.solver.{LinkNews, MessageLink, OpenLink}
import skein.units.Expect

/** A flight's link to a solver behind a Kafka broker. All flights of a prefix share the topics; each reads
  * only its own messages.
  *
  * A broker stores messages, may deliver one twice, and does not inform a writer whether there is a reader.
  * So this link counts as up from the first written message on, and as down only if a message could not be
  * written within half a second.
  */
final class KafkaLink(topics: KafkaTopics) extends MessageLink:
  private given ExecutionContext = ExecutionContext.parasitic

  /** Many, since messages pass two of Kafka's clients and a broker, which add 1.5 ms at the median before
    * their code is compiled.
    */
  override def rehearsals: Int = 400

  def open(received: Array[Byte] => Unit, news: LinkNews => Unit): OpenLink =
    val isDown = AtomicReference(Option.empty[String])
    val away   = AtomicReference(s"no Kafka broker answers at ${topics.broker}")
    val pipe   = KafkaPipe(
      topics,
      from = topics.answers,
      to = topics.questions,
      came =>
        if isDown.getAndSet(None).isDefined then news(LinkNews.Up)
        came.foreach(received)
      ,
      reason =>
        val why = s"the broker at ${topics.broker} does not take messages: $reason"
        if isDown.getAndSet(Some(why)).isEmpty then news(LinkNews.Down(why))
      ,
      away.set
    )
    pipe.start()
    pipe.ready.onComplete:
      case Success(_)     => news(LinkNews.Up)
      case Failure(error) => news(LinkNews.Refused(error.getMessage))
    new OpenLink:
      def send(message: Array[Byte]): Either[String, Unit] =
        // Messages are written while the link is down, too: a success shows that the broker is back.
        Expect.that(
          pipe.ready.value.exists(_.isSuccess) && pipe.send(message)
        )(isDown.get.getOrElse(away.get))
      def close(): Future[Done] = pipe.close().map(_ => Done)
