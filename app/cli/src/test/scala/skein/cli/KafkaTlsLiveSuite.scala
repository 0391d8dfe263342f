package skein.cli

import java.nio.file.Path
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Promise}
import skein.cluster.Certificates
import skein.flight.SolvedFlight
import skein.kafka.{KafkaBroker, KafkaLink, KafkaSolver, KafkaTopics}
import skein.link.Address
import skein.loop.FlightOutcome
import skein.record.MemoryRecorder
import skein.scenario.Scenarios
import skein.settings.SolverChoice
import skein.testing.{Lengthy, TemporaryFolders}
import skein.units.*

/** A Kafka broker with a certificate that requires clients' certificates, on loopback. */
class KafkaTlsLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy:
  private given system: ActorSystem = ActorSystem("KafkaTlsLiveSuite")
  private given Scenarios           = Scenarios.ours

  private def certificates(): Map[String, String] =
    val folder = Certificates.make(temporaryFolder(), Seq("127.0.0.1")).fold(fail(_), _.head)
    securityOf(folder)

  /** Kafka settings that `--tls` results in. */
  private def securityOf(folder: Path): Map[String, String] =
    SolverSecurity(Some(folder.toString), None)
      .checked(Some(SolverChoice.Kafka(loopback, "skein")))
      .fold(fail(_), _.kafka)

  private lazy val loopback = Address("127.0.0.1", 0)
  private lazy val own      = certificates()
  private lazy val stranger = certificates()
  private lazy val held     = temporaryFolder()
  private lazy val broker   = KafkaBroker.start(held, loopback, own).fold(fail(_), identity)

  override def afterAll(): Unit =
    broker.close()
    KafkaBroker.delete(held)
    Await.result(system.terminate(), 20.seconds): Unit
    super.afterAll()

  private def solver(topics: KafkaTopics)(told: String => Unit) =
    KafkaSolver(topics, SolvedFlight.desk(), told)

  /** A short flight, or why it failed to start. */
  private def flown(
      prefix: String,
      security: Map[String, String],
      patience: Span
  ): Either[String, MemoryRecorder] =
    val topics = KafkaTopics(broker.address, prefix)(security)
    val flight =
      SolvedFlight(SolverChoice.Kafka(broker.address, prefix), KafkaLink(topics), patience = patience)
    Await.result(flight.start(), 60.seconds).map: flying =>
      assertEquals(Await.result(flying.landed, 60.seconds).outcome, FlightOutcome.Completed)
      flight.recorder

  test("with certificates of one set, a solver behind a broker decides a flight"):
    val topics = KafkaTopics(broker.address, "trusted")(own)
    val serves = solver(topics)(_ => ())
    Await.result(serves.start(), 60.seconds)
    val recorder = flown("trusted", own, Span.ofSeconds(30)).fold(fail(_), identity)
    Await.result(serves.close(), 20.seconds)
    assert(recorder.recording.solved.sizeIs > 10, recorder.recording.solved.size)

  /** The reason that a solver reports when it gives up. */
  private def refused(at: Address, security: Map[String, String]): String =
    val serves = solver(KafkaTopics(at, "refused")(security))(_ => ())
    val why    = Await.result(serves.start().failed, 30.seconds).getMessage
    Await.result(serves.close(), 20.seconds)
    why

  private def notTrusted(at: Address) = s"no trusted connection to the Kafka broker at $at: "

  test("a client without a certificate, or with one of another set, is refused immediately, with the reason"):
    val silent = own.filterNot((key, _) => key.startsWith("ssl.key"))
    for shown <- Seq(silent, stranger) do
      assert(clue(refused(broker.address, shown)).startsWith(notTrusted(broker.address)))

  test("a broker at a host that its certificate does not contain receives no data"):
    val other = Address("localhost", broker.address.port)
    assert(clue(refused(other, own)).startsWith(notTrusted(other)))

  test("a flight that the broker refuses does not start, and reports that long before its patience ends"):
    val patience = Span.ofSeconds(600)
    val why      = flown("stranger", stranger, patience).swap.getOrElse(fail("it was flown"))
    assert(clue(why).contains(notTrusted(broker.address)))

  test("a client without TLS receives nothing, and reports the address it tried"):
    val told   = Promise[String]()
    val serves = solver(KafkaTopics(broker.address, "plain")())(line => told.trySuccess(line): Unit)
    val never  = serves.start()
    val why    = Await.result(told.future, 60.seconds)
    assert(clue(why).startsWith(s"no Kafka broker at ${broker.address}: "))
    assert(!never.isCompleted)
    Await.result(serves.close(), 20.seconds)
