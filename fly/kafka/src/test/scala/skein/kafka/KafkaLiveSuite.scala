package skein.kafka

import java.nio.file.Files
import org.apache.kafka.common.utils.Exit
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future, blocking}
import skein.flight.SolvedFlight
import skein.link.Address
import skein.loop.{LoopKind, FlightOutcome, Replay}
import skein.measure.SolverSummary
import skein.policy.Action
import skein.record.{EventKind, MemoryRecorder, Recording}
import skein.scenario.Scenarios
import skein.settings.{RecordedPlan, SolverChoice}
import skein.testing.Lengthy
import skein.units.*

/** A solver behind Kafka's own broker, on loopback. */
class KafkaLiveSuite extends munit.FunSuite, Lengthy:
  private given system: ActorSystem = ActorSystem("KafkaLiveSuite")
  private given Scenarios           = Scenarios.ours
  import system.dispatcher

  private val period = Span.ofMillis(100)
  private val folder = Files.createTempDirectory("kafka")
  private val broker = KafkaBroker.start(folder, Address("127.0.0.1", 0)).fold(fail(_), identity)

  override def afterAll(): Unit =
    broker.close()
    KafkaBroker.delete(folder)
    val _ = Await.result(system.terminate(), 20.seconds)

  /** A flight in real time with a solver over its own topics.
    *
    * @param meanwhile executed during the flight, which is then stopped
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
    assertEquals(Await.result(outcome, 3.minutes), FlightOutcome.Stopped)
    val again = RecordedPlan.of(recorder.recording).fold(fail(_), identity)
    assertEquals(Replay(again.fleet, recorder.recording).firstDifference, None)
    recorder.recording

  private def solvedSince(seen: Recording, vehicle: String, from: Instant): Int =
    seen.solved.count(one => one.vehicle == vehicle && one.askedAt > from)

  /** Polls, because other threads report their progress. */
  private def until(recorder: MemoryRecorder)(isSo: Recording => Boolean): Unit =
    val deadline = 60.seconds.fromNow
    while !isSo(recorder.recording) && deadline.hasTimeLeft() do Thread.sleep(50)
    assert(isSo(recorder.recording))

  test(
    "while a killed broker restarts, the deadline's fallback lets vehicles hover; then they fly on"
  ):
    val own                                      = Files.createTempDirectory("kafka-killed")
    val log                                      = Files.createTempFile("kafka-killed", ".log")
    val first                                    = BrokerProcess.start(own, 0, log.toFile)
    var last                                     = first
    var killedAt, backFrom                       = Instant.Epoch
    def hovers(seen: Recording, vehicle: String) =
      seen.decisions.count(one =>
        one.vehicle == vehicle && one.decidedAt > killedAt && one.action.contains(Action.Hover)
      )
    val vehicles  = Seq("Pursuer", "Evader")
    val recording =
      try
        flown("killed", first.address): recorder =>
          until(recorder)(_.solved.size > 20)
          first.kill()
          killedAt = Clock.system.now()
          until(recorder)(seen => vehicles.forall(hovers(seen, _) > 10))
          backFrom = Clock.system.now()
          last = BrokerProcess.start(own, first.address.port, log.toFile)
          until(recorder)(seen => vehicles.forall(vehicle => solvedSince(seen, vehicle, backFrom) > 10))
      finally
        last.kill()
        KafkaBroker.delete(own)
        Files.delete(log)
    for vehicle <- vehicles do
      val decisions = recording.decisions.filter(_.vehicle == vehicle)
      assertEquals(decisions.map(_.sequence), decisions.indices.map(_.toLong).toVector)
      val bySolver = recording.solved.filter(_.vehicle == vehicle)
      val missed   = recording.events
        .filter(event => event.kind == EventKind.DeadlineMissed && event.vehicle.contains(vehicle))
        .flatMap(_.decision)
      // Every decision has one maker: the solver, or the fallback of a recorded missed deadline.
      assertEquals((bySolver.map(_.decision) ++ missed).sorted, decisions.map(_.sequence))
      for decision <- decisions if missed.contains(decision.sequence) do
        assertEquals(decision.action, Some(Action.Hover), s"$vehicle, decision ${decision.sequence}")
      for one <- bySolver do
        assert(one.receivedAt < killedAt || one.askedAt > backFrom, s"$one crossed a broker that was away")
        assert(one.roundTrip <= period, s"$one came after its deadline")
      // No decision is commanded twice, and nothing else is commanded.
      val sent = recording.commands.filter(_.vehicle == vehicle).flatMap(_.decision)
      assertEquals(sent, sent.distinct.sorted)
      assertEquals(sent.toSet -- decisions.map(_.sequence), Set.empty)
    assert(recording.ending.isDefined)
    assert(SolverSummary.of(recording).exists(_.roundTripsMs.isDefined))

  test("if two solvers answer, each answer counts once"):
    val recording = flown("twice", broker.address, repeats = 2)(
      until(_)(seen => seen.solved.size > 20 && seen.events.count(_.kind == EventKind.Repeated) > 10)
    )
    val used = recording.solved.map(one => (one.vehicle, one.question))
    assertEquals(used.distinct, used)

  for (whose, number) <- Seq("clients", "its controller").zipWithIndex do
    test(s"a broker whose port for $whose is taken while it starts takes another port"):
      val folder            = Files.createTempDirectory("kafka-late")
      var asked             = 0
      def free(at: Address) =
        asked += 1
        if asked - 1 == number then broker.address.port else KafkaBroker.freed(at)
      val late = KafkaBroker.start(folder, Address("127.0.0.1", 0), Map.empty, free, attempts = 2)
      assert(late.isRight, late)
      assertEquals(asked, 4)
      late.foreach(_.close())
      KafkaBroker.delete(folder)

  test("a fault for which Kafka would end the process does not end it"):
    Exit.exit(1, "of a test")
    Exit.halt(1, "of a test")

  test("a broker whose port is taken is not started, and the error states that"):
    val at    = broker.address
    val other = Files.createTempDirectory("kafka-other")
    val no    = KafkaBroker.start(other, at)
    KafkaBroker.delete(other)
    assertEquals(no.map(_ => ()), Left(s"cannot start a broker at $at: Address already in use"))
