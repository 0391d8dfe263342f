package skein.flight

import java.nio.ByteBuffer
import java.nio.charset.StandardCharsets.US_ASCII
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.Flow
import org.apache.pekko.util.ByteString
import scala.annotation.tailrec
import scala.concurrent.Future
import skein.airsim.*
import skein.link.*
import skein.loop.{FlightOutcome, LoopKind}
import skein.measure.FlightSummary
import skein.record.*
import skein.rpc.RpcClient
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime

/** Flights with a simulator whose clock is wrong, or that has another client. */
class LyingSimulatorSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = Scenarios.ours

  private def settings(loop: LoopKind) = FlySettings(
    List(loop),
    List(LatencyProfile.direct),
    duration = Span.ofSeconds(16),
    period = Span.ofMillis(100),
    seed = 1
  )

  /** Time from the flight's start to the fault. */
  private val From = Span.ofSeconds(5)

  /** The result of a flight.
    *
    * @param told reported lines, each with the time since the flight began
    */
  private final case class Flown(landed: FlightResult, recording: Recording, told: Vector[(Span, String)]):
    def summary: FlightSummary      = FlightSummary.of(recording)
    def count(kind: EventKind): Int = recording.events.count(_.kind == kind)
    def reason: String              = landed.outcome match
      case FlightOutcome.Failed(reason) => reason
      case other                        => fail(s"it ended as $other: $told")

    def assertNoResult(kind: EventKind, words: String): Unit =
      assert(reason.contains(words), reason)
      assertEquals(count(kind), 1, recording.events.filterNot(_.kind == EventKind.Skipped).toString)
      assertEquals(recording.ending.map(_.how), Some(EndingKind.Failed))
      assert(
        told.exists((at, line) => line.contains(words) && at > From && at < From + Span.ofSeconds(7)),
        told.toString
      )
      assert(summary.noResult.exists(_.why.contains(words)), summary.noResult.toString)
      assertEquals((summary.distance, summary.result, summary.headline), (None, None, None))
      assertEquals(summary.roles.flatMap(role => role.ownTrueAgeMs ++ role.opponentTrueAgeMs), Vector.empty)
      assert(summary.name.contains("no result"), summary.name)
      assertEquals(
        recording.decisions.flatMap(_.trueAge).count(age => age.own.min(age.opponent) < Span.Zero),
        0
      )

  /** Runs a flight.
    *
    * @param shows time of the clock at a time since the fault began, s; absent if it is right
    * @param acts actions of another client then
    */
  private def fly(
      loop: LoopKind,
      shows: Option[Double => Double] = None,
      acts: AirSimClient => ActorSystem ?=> Future[Any] = _ => Future.unit
  ): Flown = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock = Clock.ofNanos(VirtualTime.clock(system))
      val duel  = settings(loop).fleet.agents.map(Vehicles.settings)
      val world =
        SimulatorSettings(WorldSettings.of(duel), Address("simulator", 41451))
      var liesFrom                   = Option.empty[Instant]
      def lied(at: Instant): Instant =
        val lie =
          for
            show <- shows
            from <- liesFrom if at >= from
          yield from + Span.ofSeconds(show(at.since(from).toSeconds))
        lie.getOrElse(at)
      val between = if loop == LoopKind.Paused then LatencyProfile.direct else LatencyProfile.none
      val network = MemoryNetwork(NetworkPlan(LinkProfile.symmetric(between)), 1, clock)
      var told    = Vector.empty[(Instant, String)]
      for
        server <- SimulatorServer.start(world, Lying(network.host("simulator"), lied), clock)
        assembler = FlightAssembler(
          network.host("controller"),
          clock,
          settings(loop),
          Some(server.address),
          tell = line => told :+= (clock.now(), line)
        )
        plan   = settings(loop).plans.head
        memory = MemoryRecorder(assembler.heading(plan, "virtual"))
        assembly <- assembler.start(plan, memory).map(_.fold(fail(_), identity))
        startedAt = clock.now()
        _ <- after(From.toDuration)(Future.unit)
        _     = liesFrom = Some(memory.recording.readings.map(_.state.validAt).max)
        other = AirSimClient(RpcClient(network.host("another"), server.address, clock))
        _      <- acts(other)
        landed <- assembly.landed
        _      <- other.close()
        _      <- server.close()
      yield Flown(landed, memory.recording, told.map((at, line) => (at.since(startedAt), line)))
    .value

  private val clocks = Vector[(String, Double => Double, String)](
    ("runs backwards", s => -s, "ran back by"),
    ("stands still", _ => 0, "stood still for"),
    ("leaps ahead", s => s + 5, "advanced by"),
    ("leaps back", s => s - 5, "ran back by"),
    ("runs at half the speed for two seconds", s => if s < 2 then s / 2 else s - 1, "advanced by"),
    ("runs at double the speed for two seconds", s => if s < 2 then s * 2 else s + 2, "advanced by"),
    ("drifts by a tenth", s => s * 0.9, "advanced by"),
    ("shows one bad time", s => if s > 1 && s < 1.08 then s - 3 else s, "ran back by")
  )

  for (what, shows, words) <- clocks do
    test(s"stream: a clock that $what ends the flight without result, and is reported"):
      fly(LoopKind.Stream, Some(shows)).assertNoResult(EventKind.ClockBroken, words)

  for loop <- LoopKind.values.toSeq.filterNot(Set(LoopKind.Stream, LoopKind.Plan)) do
    test(s"${loop.label}: a clock that runs backwards ends the flight without result"):
      fly(loop, Some(s => -s)).assertNoResult(EventKind.ClockBroken, "the simulator's ")

  for loop <- Seq(LoopKind.Stream, LoopKind.Sequential, LoopKind.Futures) do
    test(s"${loop.label}: restarts of the clocks' alignment are recorded as events"):
      val flown = fly(loop, Some(_ * 0.98))
      assertEquals(flown.landed.outcome, FlightOutcome.Completed)
      assert(flown.count(EventKind.ClockRestarted) > 0)
      assert(flown.count(EventKind.ClockDrift) > 0)
      assert(
        flown.told.exists((_, line) => line.contains("the simulator's clock advanced by")),
        flown.told.toString
      )
      assertEquals(flown.summary.noResult, None)

  for loop <- LoopKind.values.toSeq.filterNot(_ == LoopKind.Plan) do
    test(s"${loop.label}: with a correct simulator nothing is reported, and the flight has its result"):
      val flown = fly(loop)
      assertEquals(flown.landed.outcome, FlightOutcome.Completed)
      assertEquals(flown.told, Vector.empty)
      assertEquals(flown.summary.noResult, None)
      assertEquals(
        flown.recording.events.map(_.kind).filter(Set(
          EventKind.ClockRestarted,
          EventKind.ClockDrift,
          EventKind.ClockBroken,
          EventKind.VehicleTaken,
          EventKind.Starved
        )),
        Vector.empty
      )
      assert(flown.summary.distance.isDefined)

  private val taken = Vector[(String, AirSimClient => ActorSystem ?=> Future[Any], String)](
    ("resets the simulator", _.reset(), ""),
    ("takes api control away", Multirotor(_, "Pursuer").enableApiControl(false), "no longer gives Pursuer"),
    (
      "puts a vehicle elsewhere",
      Multirotor(_, "Evader").setPose(VehiclePose(Vector3(30, 10, -20), Quaternion.Identity)),
      "Evader is "
    ),
    (
      "puts a vehicle back to where it began",
      Multirotor(_, "Evader").setPose(VehiclePose(Vector3(0, 0, -20), Quaternion.Identity)),
      "Evader is "
    ),
    ("moves a vehicle", moves(_), "another client moves Pursuer")
  )

  /** Moves the pursuer ten times per second, for three seconds. */
  private def moves(client: AirSimClient)(using system: ActorSystem): Future[Any] =
    val pursuer                        = Multirotor(client, "Pursuer")
    def again(left: Int): Future[Unit] =
      pursuer.moveByVelocity(Vector3(5, 0, 0), Span.ofSeconds(1)): Unit
      if left == 0 then Future.unit else after(Span.ofMillis(100).toDuration)(again(left - 1))
    again(30)

  for
    (what, acts, words) <- taken
    loop                <- Seq(LoopKind.Stream, LoopKind.Futures, LoopKind.Paused)
  do
    test(s"${loop.label}: another client that $what ends the flight without result, and is reported"):
      fly(loop, acts = acts).assertNoResult(EventKind.VehicleTaken, words)

  test("one or two foreign moves are tolerated, and so are moves whose time had elapsed"):
    def at(ms: Double)    = Instant.Epoch + Span.ofMillis(ms)
    def move(number: Int) =
      CommandRow(number, "A", None, MetresPerSecond(0), MetresPerSecond(0), Metres(0), at(100.0 * number))
    def end(number: Int, ms: Double) =
      Acknowledgement("A", number, at(ms), CommandOutcome.Superseded)
    val lasts                                                         = Span.ofSeconds(1)
    def flown(end: (Int, ForeignMoves) => ForeignMoves): ForeignMoves =
      (0 until 20).foldLeft(ForeignMoves())((moves, number) => end(number, moves.sent(move(number))))
    val own = flown((number, moves) => moves.ended(end(number - 1, 100.0 * number + 40), lasts))
    assert(!own.areMany, "each is answered behind its successor")
    assert(flown((number, moves) => moves.ended(end(number, 100.0 * number + 40), lasts)).areMany)
    val one = flown((number, moves) =>
      if number == 7 then moves.ended(end(number, 740), lasts)
      else moves.ended(end(number - 1, 100.0 * number + 40), lasts)
    )
    assert(!one.areMany)
    assert(!flown((number, moves) => moves.ended(end(number, 100.0 * number + 1000), lasts)).areMany)

  test("stream: a client that disarms a vehicle does not end the flight: moves drive it on, as in AirSim"):
    def flown(acts: AirSimClient => ActorSystem ?=> Future[Any]) =
      val flight = fly(LoopKind.Stream, acts = acts)
      assertEquals(flight.landed.outcome, FlightOutcome.Completed)
      val downM = flight.recording.readings.filter(_.vehicle == "Evader").map(_.state.value.positionNed.z)
      (downM.max, flight.summary.headline.get)
    def disarms(client: AirSimClient)(using system: ActorSystem) =
      Multirotor(client, "Evader").disarm().map(assertEquals(_, Right(true)))(using system.dispatcher)
    val (disarmed, alone) = (flown(disarms(_)), flown(_ => Future.unit))
    assertEqualsDouble(disarmed._1, alone._1, 0.001, "it sank")
    assertEqualsDouble(disarmed._2, alone._2, 0.001, "it flew another way")

  test("stream: if another client pauses the simulator, the flight ends without a result"):
    fly(LoopKind.Stream, acts = _.pause()).assertNoResult(EventKind.ClockBroken, "stood still")

  test("paused: another client that resumes the simulator is recorded"):
    assert(fly(LoopKind.Paused, acts = _.resume()).count(EventKind.StepDrift) > 0)

  /** Changes the time stamps in the simulator's messages. */
  private final class Lying(transport: Transport, lied: Instant => Instant) extends Transport:
    def connect(to: Address) = transport.connect(to)
    def listen(at: Address)  = transport.listen(at).map: incoming =>
      incoming.copy(flow = Flow[ByteString].map(stamped).via(incoming.flow))

    private def stamped(bytes: ByteString): ByteString =
      @tailrec def next(done: ByteString, rest: ByteString): ByteString =
        rest.indexOfSlice(Lying.Key) match
          case -1 => done ++ rest
          case at =>
            val begin = at + Lying.Key.length
            val shown = Instant.ofNanos(rest.slice(begin, begin + 8).toByteBuffer.getLong)
            val bytes = ByteString(ByteBuffer.allocate(8).putLong(lied(shown).toNanos).flip())
            next(done ++ rest.take(begin) ++ bytes, rest.drop(begin + 8))
      next(ByteString.empty, bytes)

  private object Lying:
    /** The beginning of a multirotor state's time stamp in MessagePack: its key, and the tag of 64 bits. */
    val Key: ByteString = ByteString("timestamp".getBytes(US_ASCII)) ++ ByteString(0xcf.toByte)
