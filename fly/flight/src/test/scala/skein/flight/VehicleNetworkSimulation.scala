package skein.flight

import java.nio.file.Files
import skein.loop.{FlightOutcome, LoopKind, Reading}
import skein.measure.RoundTripTrace
import skein.record.{DecisionRow, EventKind, MemoryRecorder, ReadingRow, Recording}
import skein.scenario.{PaperDuel, Scenario, Scenarios, Surround}
import skein.settings.{FlySettings, NamedScene, VehicleLink}
import skein.signal.LatencyProfile
import skein.testing.{Optimised, TemporaryFolders}
import skein.units.*

/** Flights in virtual time whose controllers know one another by messages. */
class VehicleNetworkSimulation extends munit.FunSuite, TemporaryFolders, Optimised:
  private given Scenarios = Scenarios.ours

  private val loops = List(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive)

  private def settings(
      loop: LoopKind,
      between: String,
      link: LatencyProfile = LatencyProfile.vpn,
      scenario: Scenario = PaperDuel(),
      seconds: Int = 4
  ) = FlySettings(
    List(loop),
    List(link),
    duration = Span.ofSeconds(seconds),
    period = Span.ofMillis(100),
    seed = 1,
    scenario = scenario,
    decentralised = true,
    between = Some(VehicleLink.parse(between).fold(fail(_), identity))
  )

  private def steady(link: String) =
    LatencyProfile.parse(link, Left(_)).fold(wrong => fail(wrong.message), identity)

  private def fly(settings: FlySettings, seed: Long = 1): MemoryRecorder =
    val flown = VirtualFlights.fly(settings, settings.plans.head.copy(seed = seed)).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    flown.recorder

  /** Readings of other vehicles, with the controller that received them, and the readings they were sent for.
    */
  private def messages(recording: Recording): Vector[(to: Int, sent: ReadingRow, received: ReadingRow)] =
    val names = recording.heading.vehicles.map(_.name)
    val asked = Reading.asked(recording).map(read => (read.vehicle, read.sequence) -> read).toMap
    for
      read <- recording.readings
      from = names.indexOf(read.vehicle)
      to   = (read.sequence % names.size).toInt
      if to != from
    yield (to = to, sent = asked((read.vehicle, read.sequence - to + from)), received = read)

  private def lost(recording: Recording) =
    recording.events.filter(_.kind == EventKind.MessagesLost).flatMap(_.count).sum

  for loop <- loops do
    folder.test(
      s"${loop.label}: equal seeds give equal flights, different seeds do not, and a recording replays"
    ): folder =>
      val flight = settings(loop, "range:60m,loss:10%/4,vpn", scenario = PaperDuel(pairs = 2))
      val flown  = fly(flight)
      assertNotEquals(fly(flight, seed = 2).digest, flown.digest)
      val file = flight.plans.head.file(folder)
      assert(flown.writeTo(file).isRight)
      val replayed = Replayed.of(file).fold(fail(_), identity)
      assertEquals((replayed.decidedAgain, replayed.isSame), (None, true))

  test("a message carries its sender's reading, arrives after the link's delay, and is used in decisions"):
    val recording = fly(settings(LoopKind.Stream, "constant:80ms", scenario = Surround())).recording
    val sent      = messages(recording)
    assert(sent.nonEmpty)
    for one <- sent do
      assertEquals(one.received.state, one.sent.state.copy(receivedAt = one.received.state.receivedAt))
      assertEquals(one.received.state.receivedAt.since(one.sent.state.receivedAt), Span.ofMillis(40))
    val own = recording.heading.vehicles.map(_.name)
    for made <- recording.decisions do
      assertEquals(made.opponent.sequence % own.size, own.indexOf(made.vehicle).toLong)
      assertEquals(
        made.observations.opponentAge,
        made.decidedAt.since(made.opponent.state.receivedAt)
      )
    assertEquals(lost(recording), 0L)

  test("slow messages do not change the ages of what a controller reads itself"):
    val slow = settings(LoopKind.Stream, "constant:400ms", steady("constant:200ms"), Surround())
    for made <- fly(slow).recording.decisions; age <- made.trueAge do
      // The simulator's clock is the controller's here.
      assertEqualsDouble(age.own.toMillis, made.decidedAt.since(made.own.state.validAt).toMillis, 1)
      assertEqualsDouble(age.opponent.toMillis, made.decidedAt.since(made.opponent.state.validAt).toMillis, 1)

  for loop <- Seq(LoopKind.Stream, LoopKind.Predictive) do
    test(s"${loop.label}: without delay and loss, messages are as good as readings of one's own"):
      def decisions(recording: Recording): Vector[DecisionRow] =
        recording.decisions.sortBy(made => (made.vehicle, made.sequence)).map: made =>
          made.copy(own = made.own.copy(sequence = 0), opponent = made.opponent.copy(sequence = 0))
      val byMessages = settings(loop, "none", LatencyProfile.none)
      assertEquals(
        decisions(fly(byMessages).recording),
        decisions(fly(byMessages.copy(between = None)).recording)
      )

  test("the link of each controller has one trace, that of its own vehicle"):
    val recording = fly(settings(LoopKind.Stream, "vpn", scenario = Surround())).recording
    assertEquals(RoundTripTrace.of(recording).size, recording.heading.vehicles.size)

  test("lost messages are counted, and what is not lost arrives"):
    val recording = fly(settings(LoopKind.Stream, "loss:10%,constant:40ms", seconds = 30)).recording
    val asked     = Reading.asked(recording).size
    val arrived   = messages(recording).size
    assert(
      (asked - arrived - lost(recording)).abs <= 4,
      s"$asked sent, $arrived arrived, ${lost(recording)} lost"
    )
    val share = lost(recording).toDouble / asked
    assert(share > 0.06 && share < 0.14, s"$share lost")

  test("beyond the range only the first message of each arrives"):
    val recording = fly(settings(LoopKind.Stream, "range:5m,none", LatencyProfile.none)).recording
    assertEquals(messages(recording).map(_.to).sorted, Vector(0, 1))
    assert(
      recording.events.exists(_.detail.contains("out of range")),
      recording.events.map(_.detail).toString
    )

  folder.test("what stands between two vehicles stops their messages"): folder =>
    val file = folder.resolve("wall.conf")
    Files.writeString(file, "objects = [{ box = [1, 200, 100], at = [10, 0] }]")
    val scene     = NamedScene.read(file.toString).fold(fail(_), identity)
    val flight    = settings(LoopKind.Stream, "none", LatencyProfile.none, seconds = 2)
    val recording = fly(flight.copy(scene = Some(scene))).recording
    assertEquals(messages(recording).map(_.to).sorted, Vector(0, 1))
    assert(
      recording.events.exists(_.detail.contains("out of sight")),
      recording.events.map(_.detail).toString
    )
