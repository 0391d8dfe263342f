package skein.flight

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.*
import skein.loop.{LoopKind, FlightOutcome}
import skein.record.*
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.torture.{Disk, FaultyRecorder}
import skein.units.*
import skein.vtime.VirtualTime

/** The reports, records and outcomes of flights with faults, and their times. */
class FailureTellingSimulation extends munit.FunSuite, Unhurried:
  private def settings(loop: LoopKind) = FlySettings(
    List(loop),
    List(LatencyProfile.direct),
    duration = Span.ofSeconds(12),
    period = Span.ofMillis(100),
    seed = 1
  )

  /** The result of a flight.
    *
    * @param told reported lines, each with the time since the flight began
    * @param wentWrong time of the fault, likewise
    * @param seen the text of the progress line 2 s after that
    */
  private final case class Flown(
      landed: FlightResult,
      recording: Recording,
      told: Vector[(Span, String)],
      wentWrong: Span,
      seen: String
  ):
    def toldInTime(what: String): String = told
      .collectFirst {
        case (at, line) if line.contains(what) && at >= wentWrong && at <= wentWrong + Span.ofSeconds(1) =>
          line
      }
      .getOrElse(fail(s"not told within a second of ${wentWrong.toSeconds} s: $told"))

  /** Runs a flight with a fault after 5 s.
    *
    * @param restarts time from the simulator's end to its restart
    * @param stall duration of a stall of all messages
    */
  private def fly(
      loop: LoopKind = LoopKind.Stream,
      dies: Boolean = false,
      restarts: Option[Span] = None,
      stall: Option[Span] = None,
      disk: Boolean = false
  ): Flown = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock     = Clock.ofNanos(VirtualTime.clock(system))
      val wentWrong = Span.ofSeconds(5)
      val duel      = settings(loop).fleet.agents.map(agent =>
        VehicleSettings(agent.name, agent.startPositionNed.copy(z = 0), agent.startHeading)
      )
      val world =
        SimulatorSettings(WorldSettings.of(duel), Address("simulator", 41451))
      // A flight's start is not known in advance, so its link is stalled from outside.
      var gate = Option.empty[Instant]
      // `paused` has no link of its own: with answers that take no time it would end immediately.
      val between = if loop == LoopKind.Paused then LatencyProfile.direct else LatencyProfile.none
      val network = MemoryNetwork(NetworkPlan(LinkProfile.symmetric(between)), 1, clock)
      var told    = Vector.empty[(Instant, String)]
      for
        server <- SimulatorServer.start(world, Stalling(network.host("simulator"), clock, () => gate), clock)
        assembler = FlightAssembler(
          network.host("controller"),
          clock,
          settings(loop),
          Some(server.address),
          tell = line => told :+= (clock.now(), line)
        )
        plan   = settings(loop).plans.head
        memory = MemoryRecorder(assembler.heading(plan, "virtual"))

        faulty = Late(memory, clock, Option.when(disk)(wentWrong))
        assembly <- assembler.start(plan, faulty).map(_.fold(fail(_), identity))
        startedAt = clock.now()
        _         = faulty.startedAt = Some(startedAt)
        _     <- after(wentWrong.toDuration)(Future.unit)
        _     <- if dies then server.close() else Future.unit
        again <- restarts.fold(Future.successful(Option.empty[SimulatorServer])): pause =>
          after(pause.toDuration)(SimulatorServer.start(world, network.host("simulator"), clock)).map(Some(_))
        _ = gate = stall.map(clock.now() + _)
        _ <- after(Span.ofSeconds(2).toDuration)(Future.unit)
        seen = assembly.progress.text
        landed <- assembly.landed
        _      <- if dies then Future.unit else server.close()
        _      <- again.fold(Future.unit)(_.close().map(_ => ()))
      yield Flown(
        landed,
        memory.recording,
        told.map((at, line) => (at.since(startedAt), line)),
        wentWrong,
        seen
      )
    .value

  for
    loop <- LoopKind.values.toSeq
  do
    test(
      s"${loop.label}: a simulator that dies in flight fails the flight, and is reported within a second"
    ):
      val flown = fly(loop, dies = true)
      val line  = flown.toldInTime("no answer from the simulator at simulator:41451")
      assert(line.startsWith(s"${flown.landed.plan.id}: "), line)
      assert(flown.landed.outcome.isInstanceOf[FlightOutcome.Failed], flown.landed.toString)
      assertEquals(flown.recording.ending.map(_.how), Some(EndingKind.Failed))
      assert(flown.recording.ending.flatMap(_.reason).isDefined)
      val noted = flown.recording.events.filter(_.kind == EventKind.SimulatorSilent)
      assertEquals(noted.size, 1, noted.toString)
      assert(flown.seen.contains("no answer for 2 s"), flown.seen)
      val ended = flown.recording.ending.get.at.since(flown.recording.heading.flight.startedAt)
      assert(flown.told.exists((_, line) => line.contains("told to hover")), flown.told.toString)
      assert(ended < Span.ofSeconds(80), s"it went on for ${ended.toSeconds} s")

  test(
    "a simulator's silence of 3 s, and its return, are reported, and the flight continues to its end"
  ):
    val flown = fly(stall = Some(Span.ofSeconds(3)))
    val _     = flown.toldInTime("no answer from the simulator")
    assert(flown.told.exists((_, line) => line.contains("answers again, after 3")), flown.told.toString)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    assertEquals(
      flown.recording.events.map(_.kind).filter(kind =>
        kind == EventKind.SimulatorSilent || kind == EventKind.SimulatorBack
      ),
      Vector(EventKind.SimulatorSilent, EventKind.SimulatorBack)
    )
    assertEquals(flown.recording.ending.map(_.how), Some(EndingKind.Completed))

  for
    loop  <- Seq(LoopKind.Stream, LoopKind.Predictive)
    pause <- Seq(Span.ofMillis(200), Span.ofSeconds(3))
  do
    test(
      s"${loop.label}: a restart of the simulator after ${pause.toMillis} ms fails the flight"
    ):
      val flown = fly(loop, dies = true, restarts = Some(pause))
      // A quickly restarted simulator is detected by its vehicles' positions.
      def saysWhy(text: String) =
        text.contains("the simulator at simulator:41451 no longer gives ") ||
          text.contains("from where it can have flown")
      flown.landed.outcome match
        case FlightOutcome.Failed(reason) => assert(saysWhy(reason), reason)
        case other                        => fail(s"it ended as $other")
      // It is checked once the client, which waits up to 2 s between two attempts, is connected.
      val latest = flown.wentWrong + pause + Span.ofSeconds(3)
      assert(flown.told.exists((at, line) => saysWhy(line) && at < latest), flown.told.toString)
      assertEquals(flown.recording.ending.map(_.how), Some(EndingKind.Failed))

  test("a disk that fills up in flight is reported within a second, and the recording's end states why"):
    val flown  = fly(disk = true)
    val reason = "cannot write to recording flight.duckdb: the disk is full"
    val _      = flown.toldInTime(reason)
    assertEquals(flown.landed.outcome, FlightOutcome.Failed(reason))
    assertEquals(flown.recording.ending.flatMap(_.reason), Some(reason))

  test("the age in the progress line is that of the newest reading now"):
    val flown = fly()
    val age   = "apart, +([0-9]+) ms old".r.findFirstMatchIn(flown.seen).map(_.group(1).toInt)
    assert(age.exists(ms => ms > 5 && ms < 250), flown.seen)
    assertEquals(flown.told, Vector.empty)

  /** A disk that fails a fixed time after the flight began. */
  private final class Late(recorder: Recorder, clock: Clock, fails: Option[Span]) extends Recorder:
    var startedAt         = Option.empty[Instant]
    private lazy val disk =
      new FaultyRecorder(recorder, fails.fold(Disk.Sound)(Disk.Fails(_)), clock, startedAt.get)
    private val failed                  = scala.concurrent.Promise[RecordError]()
    def offer(record: Recordable): Unit =
      if startedAt.isEmpty then recorder.offer(record)
      else
        disk.offer(record)
        disk.failure.value.foreach(failed.tryComplete)
    def failure = failed.future
    def close() = recorder.close()

  /** Holds the simulator's messages until `gate`. */
  private final class Stalling(transport: Transport, clock: Clock, gate: () => Option[Instant])(using
      system: ActorSystem
  ) extends Transport:
    def connect(to: Address) = transport.connect(to)
    def listen(at: Address)  = transport.listen(at).map: incoming =>
      val held = org.apache.pekko.stream.scaladsl.Flow[org.apache.pekko.util.ByteString].mapAsync(64):
        bytes =>
          gate().filter(_ > clock.now()) match
            case Some(until) => after(until.since(clock.now()).toDuration)(Future.successful(bytes))
            case None        => Future.successful(bytes)
      incoming.copy(flow = held.via(incoming.flow))
