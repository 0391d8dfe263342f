package skein.kafka

import scala.concurrent.Future
import skein.solver.SolverDesk

/** A solver behind a Kafka broker. Only one may run for each prefix: a second one would answer every request
  * again.
  *
  * @param told receives a line for the user: why the broker cannot be used yet, or what could not be written
  */
final class KafkaSolver(topics: KafkaTopics, desk: SolverDesk, told: String => Unit):
  private val pipe: KafkaPipe = KafkaPipe(
    topics,
    from = topics.questions,
    to = topics.answers,
    came => taken(came),
    reason => told(s"the broker at ${topics.broker} does not take answers: $reason"),
    told
  )

  // Invalid messages are counted there; the next ones are read.
  private def taken(came: Seq[Array[Byte]]): Unit =
    desk.received(came, message => pipe.send(message): Unit): Unit

  /** Completes when it accepts requests; waits for a broker that is not reachable yet, and fails if the
    * broker refuses it.
    */
  def start(): Future[Unit] =
    pipe.start()
    pipe.ready

  def close(): Future[Unit] = pipe.close()
