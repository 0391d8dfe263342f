package skein.kafka

import java.nio.file.Files
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future, blocking}
import skein.flight.SolvedFlight
import skein.link.Address
import skein.loop.{LoopKind, Outcome, Replay}
import skein.measure.SolverSummary
import skein.policy.Action
import skein.record.{EventKind, MemoryRecorder, Recording}
import skein.scenario.Scenarios
import skein.settings.{RecordedPlan, SolverChoice}
import skein.testing.Unhurried
import skein.units.*

/** A solver behind Kafka's own broker, one for all tests, on loopback. */
class KafkaLiveSuite extends munit.FunSuite, Unhurried:
  private given system: ActorSystem = ActorSystem("KafkaLiveSuite")
  private given Scenarios           = Scenarios.ours
  import system.dispatcher

  private val folder = Files.createTempDirectory("kafka")
  private var broker = Option.empty[KafkaBroker]

  private def started(port: Int): KafkaBroker =
    val one = KafkaBroker.start(folder, Address("127.0.0.1", port)).fold(fail(_), identity)
    broker = Some(one)
    one

  override def afterAll(): Unit =
    broker.foreach(_.close())
    KafkaBroker.delete(folder)
    val _ = Await.result(system.terminate(), 20.seconds)

  /** Flown in real time by a solver over topics of its own.
    *
    * @param meanwhile
    *   done while it flies; then it is stopped
    */
  private def flown(
      prefix: String,
      at: Address,
      repeats: Int = 1
  )(meanwhile: MemoryRecorder => Unit): Recording =
    val topics  = KafkaTopics(at, prefix)()
    val solvers = (1 to repeats).map(id => KafkaSolver(topics, SolvedFlight.desk(id), _ => ()))
    val flight  = SolvedFlight(
      SolverChoice.Kafka(at, prefix),
      KafkaLink(topics),
      LoopKind.Predictive,
      duration = Span.ofSeconds(120)
    )
    Await.result(Future.traverse(solvers)(_.start()), 60.seconds): Unit
    val recorder = flight.recorder
    val outcome  =
      for
        started <- flight.start()
        flying = started.fold(fail(_), identity)
        _      <- Future(blocking(meanwhile(recorder))).andThen(_ => flying.stop("seen enough"))
        landed <- flying.landed
        _      <- Future.traverse(solvers)(_.close())
      yield landed.outcome
    assertEquals(Await.result(outcome, 3.minutes), Outcome.Stopped)
    val again = RecordedPlan.of(recorder.recording).fold(fail(_), identity)
    assertEquals(Replay(again.fleet, recorder.recording).firstDifference, None)
    recorder.recording

  /** Asks again and again, since other threads tell when they have come so far. */
  private def until(recorder: MemoryRecorder)(isSo: Recording => Boolean): Unit =
    val deadline = 60.seconds.fromNow
    while !isSo(recorder.recording) && deadline.hasTimeLeft() do Thread.sleep(50)
    assert(isSo(recorder.recording))

  test(
    "a broker that is killed and started again in a flight: vehicles hover meanwhile, fly on, and all is recorded"
  ):
    val first     = started(0)
    val at        = first.address
    var since     = Instant.Epoch
    val recording = flown("killed", at): recorder =>
      until(recorder)(_.solved.size > 20)
      first.close()
      until(recorder)(_.decisions.count(_.action.contains(Action.Hover)) > 10)
      started(at.port): Unit
      since = Clock.system.now()
      until(recorder)(_.solved.count(_.receivedAt > since) > 20)
    for vehicle <- Seq("Pursuer", "Evader") do
      val own = recording.decisions.filter(_.vehicle == vehicle)
      assertEquals(own.map(_.sequence), own.indices.map(_.toLong).toVector)
      assert(own.exists(_.action.contains(Action.Hover)), vehicle)
      assert(
        recording.solved.exists(one => one.vehicle == vehicle && one.receivedAt > since),
        s"$vehicle does not fly on"
      )
      // However long the broker is away, somebody decides; a busy machine may stand still for a second or two.
      val gaps = own.zip(own.drop(1)).map((one, next) => next.decidedAt.since(one.decidedAt).toMillis)
      assert(gaps.max < 5000, s"$vehicle was not decided for over ${gaps.max} ms")
    assert(recording.events.exists(_.kind == EventKind.DeadlineMissed))
    assert(SolverSummary.of(recording).exists(_.roundTripsMs.isDefined))

  test("where two solvers answer, each answer counts once"):
    val recording = flown("twice", broker.get.address, repeats = 2)(
      until(_)(seen => seen.solved.size > 20 && seen.events.count(_.kind == EventKind.Repeated) > 10)
    )
    val used = recording.solved.map(one => (one.vehicle, one.question))
    assertEquals(used.distinct, used)

  test("a broker whose port is taken is not started, and says so"):
    val at    = broker.get.address
    val other = Files.createTempDirectory("kafka-other")
    val no    = KafkaBroker.start(other, at)
    KafkaBroker.delete(other)
    assertEquals(no.map(_ => ()), Left(s"cannot start a broker at $at: Address already in use"))
