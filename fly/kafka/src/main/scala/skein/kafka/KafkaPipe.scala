package skein.kafka

import java.io.IOException
import java.time.Duration
import java.util.concurrent.atomic.{AtomicBoolean, AtomicLong}
import java.util.concurrent.{ArrayBlockingQueue, TimeUnit}
import org.apache.kafka.clients.consumer.KafkaConsumer
import org.apache.kafka.clients.producer.{KafkaProducer, ProducerRecord}
import org.apache.kafka.common.TopicPartition
import org.apache.kafka.common.errors.{RetriableException, WakeupException}
import org.apache.kafka.common.serialization.{ByteArrayDeserializer, ByteArraySerializer}
import scala.annotation.tailrec
import scala.concurrent.{Future, Promise}
import scala.jdk.CollectionConverters.*
import scala.util.control.NonFatal

/** One side of two topics: writes messages to one, and reads from the other, each on its own thread, since
  * Kafka's clients may block. Reads messages from the moment of opening on.
  *
  * @param received called with each batch of messages, in order
  * @param lost called with the reason when a message was not written in time
  * @param absent called with the reason why the broker cannot be used yet, whenever it changes
  */
private[kafka] final class KafkaPipe(
    topics: KafkaTopics,
    from: String,
    to: String,
    received: Seq[Array[Byte]] => Unit,
    lost: String => Unit,
    absent: String => Unit
):
  import KafkaPipe.*

  private val closing  = AtomicBoolean(false)
  private val reading  = Promise[Unit]()
  private val closed   = Promise[Unit]()
  private val leftOver = AtomicLong(2)
  private val outgoing = ArrayBlockingQueue[Array[Byte]](MostWaiting)

  @volatile private var consumer = Option.empty[KafkaConsumer[Array[Byte], Array[Byte]]]

  // Set when a message was not written: a broker that is back may be a new one, without topics.
  @volatile private var isDoubtful = false

  /** Completes once messages that others write from now on will be read; fails if the broker refuses, without
    * retries.
    */
  def ready: Future[Unit] = reading.future

  def start(): Unit =
    thread("reads", read())
    thread("writes", write())

  /** Queues a message; false if the queue is full. */
  def send(message: Array[Byte]): Boolean = outgoing.offer(message)

  def close(): Future[Unit] =
    if closing.compareAndSet(false, true) then consumer.foreach(_.wakeup())
    closed.future

  private def thread(does: String, body: => Unit): Unit =
    val runs: Runnable = () =>
      try body
      catch
        case NonFatal(error) =>
          val _ = reading.tryFailure(error)
          if !closing.get then lost(s"$does no more: $error")
      finally if leftOver.decrementAndGet() == 0 then closed.trySuccess(()): Unit
    Thread.ofPlatform.daemon.name(s"skein-kafka-$does-$from").start(runs): Unit

  /** Whether the broker can be used; waits until it is reachable. */
  @tailrec
  private def isReached(told: String = ""): Boolean = !closing.get && (topics.made() match
    case Right(()) => true
    case Left(no)  =>
      if no.isFinal then
        val _ = reading.tryFailure(IOException(no.reason))
        false
      else
        if no.reason != told then absent(no.reason)
        Thread.sleep(TryEveryMs)
        isReached(no.reason))

  private def read(): Unit =
    if isReached() then
      val settings = KafkaTopics.settings(topics)(
        "fetch.max.wait.ms"      -> "100",
        "fetch.min.bytes"        -> "1",
        "auto.offset.reset"      -> "latest",
        "enable.auto.commit"     -> "false",
        "check.crcs"             -> "true",
        "default.api.timeout.ms" -> "2000"
      )
      val reader = KafkaConsumer(settings, ByteArrayDeserializer(), ByteArrayDeserializer())
      consumer = Some(reader)
      try
        val part = TopicPartition(from, 0)
        reader.assign(java.util.List.of(part))
        var isPlaced = false
        while !closing.get do
          try
            if isDoubtful && topics.made().isRight then
              isDoubtful = false
              isPlaced = false
            if !isPlaced then
              reader.seekToEnd(java.util.List.of(part))
              reader.position(part): Unit
              isPlaced = true
              val _ = reading.trySuccess(())
            val came = reader.poll(Duration.ofMillis(PollMs)).asScala.map(_.value).filter(_ != null).toVector
            if came.nonEmpty then received(came)
          catch
            case _: WakeupException => ()
            // An unreachable broker comes back; an error of a reachable one stays, and is reported.
            case _: RetriableException => ()
      finally reader.close()

  private def failed(error: Throwable): Unit =
    isDoubtful = true
    if !closing.get then lost(s"${error.getMessage}")

  private def write(): Unit =
    val settings = KafkaTopics.settings(topics)(
      "acks"                                  -> "1",
      "linger.ms"                             -> "0",
      "compression.type"                      -> "none",
      "enable.idempotence"                    -> "false",
      "max.in.flight.requests.per.connection" -> "1",
      // A late request has a late answer: after this time it is worthless.
      "request.timeout.ms"  -> "400",
      "delivery.timeout.ms" -> "500",
      "max.block.ms"        -> "500",
      "max.request.size"    -> "1000000"
    )
    var writer = Option.empty[KafkaProducer[Array[Byte], Array[Byte]]]
    try
      while !closing.get || !outgoing.isEmpty do
        val message = outgoing.poll(PollMs, TimeUnit.MILLISECONDS)
        if message != null then
          try
            if writer.isEmpty then
              writer = Some(KafkaProducer(settings, ByteArraySerializer(), ByteArraySerializer()))
            writer.get.send(
              ProducerRecord(to, 0, null: Array[Byte], message),
              (_, error) => if error != null then failed(error)
            ): Unit
          catch case NonFatal(error) => failed(error)
    finally writer.foreach(_.close(Duration.ofMillis(600)))

private[kafka] object KafkaPipe:
  private val MostWaiting = 256
  private val PollMs      = 200L
  private val TryEveryMs  = 300L
