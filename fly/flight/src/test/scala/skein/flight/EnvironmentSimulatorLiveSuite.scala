package skein.flight

import java.io.{BufferedReader, InputStreamReader}
import java.net.{StandardProtocolFamily, UnixDomainSocketAddress}
import java.nio.channels.{Channels, ServerSocketChannel, SocketChannel}
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.Files
import java.util.concurrent.atomic.AtomicLong
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import skein.loop.{LoopKind, LoopSettings, FlightOutcome}
import skein.policy.Action
import skein.port.VehicleError
import skein.record.{ClockKind, EventKind, MemoryRecorder, Recording}
import skein.scenario.Surround
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*
import skein.vehicle.ConstantVelocity
import skein.vtime.VirtualTime

/** Environments in another process, here on a thread of this one. */
class EnvironmentSimulatorLiveSuite extends munit.FunSuite, Unhurried:
  private val names = Vector("Evader", "Pursuer1", "Pursuer2")

  /** Points that follow half of their commanded velocity; the reward is minus the distance from the origin.
    * It ends after `lasts` steps.
    */
  private final class Points(lasts: Int = Int.MaxValue):
    private var places = Vector.empty[Vector3]
    private var moves  = Vector.empty[Vector3]
    private var steps  = 0

    def reset(): Unit =
      places = Vector(Vector3(10, 0, -5), Vector3(0, -4, -5), Vector3(0, 4, -5))
      moves = names.map(_ => Vector3.Zero)
      steps = 0

    def step(velocities: Vector[Vector3]): Unit =
      moves = velocities.map(_ * 0.5)
      places = places.zip(moves).map((place, move) => place + move * 0.1)
      steps += 1

    def rewards: Vector[Double] = places.map(place => if steps == 0 then 0.0 else -place.norm)

    def told: String = ujson.Obj(
      "stepS"    -> 0.1,
      "vehicles" -> ujson.Obj.from(names.indices.map: i =>
        val (p, v) = (places(i), moves(i))
        names(i) -> ujson.Obj(
          "body"       -> ujson.Arr(p.x, p.y, p.z, v.x, v.y, v.z, 0.0),
          "reward"     -> rewards(i),
          "terminated" -> (steps >= lasts),
          "truncated"  -> false
        ))
    ).render()

  /** Serves one connection.
    *
    * @param answer answers a line; absent to end the process
    */
  private def served[A](answer: ujson.Value => Option[String])(use: String => A): A =
    val path   = Files.createTempDirectory("environment").resolve("socket")
    val server = ServerSocketChannel.open(StandardProtocolFamily.UNIX).bind(UnixDomainSocketAddress.of(path))
    val thread = Thread.ofPlatform.daemon.start: () =>
      val channel = server.accept()
      try serve(channel, answer)
      catch case _: java.nio.channels.ClosedByInterruptException => ()
      finally channel.close()
    try use(path.toString)
    finally
      thread.interrupt()
      thread.join()
      server.close()
      Files.delete(path)
      Files.delete(path.getParent)

  private def serve(channel: SocketChannel, answer: ujson.Value => Option[String]): Unit =
    val lines = BufferedReader(InputStreamReader(Channels.newInputStream(channel), UTF_8))
    val out   = Channels.newOutputStream(channel)
    var line  = lines.readLine
    while line != null do
      answer(ujson.read(line)) match
        case Some(told) =>
          out.write(s"$told\n".getBytes(UTF_8))
          line = lines.readLine
        case None => line = null

  private def points(world: Points)(asked: ujson.Value): Option[String] =
    asked.obj.get("velocities") match
      case None    => world.reset()
      case Some(v) => world.step(names.map(name => Vector3(v(name)(0).num, v(name)(1).num, v(name)(2).num)))
    Some(world.told)

  private def started(path: String, recorder: MemoryRecorder, clock: Clock)(using system: ActorSystem) =
    for
      process <- EnvironmentProcess.connect(path, names)
      started <- EnvironmentSimulator.start(process, names, clock, recorder, system.dispatcher)
    yield started

  private def recorderOf(clock: Clock) =
    MemoryRecorder(PortFlight(
      "x",
      LoopKind.Paused,
      Surround(3),
      Span.ofSeconds(1),
      ClockKind.Virtual,
      clock
    ).heading)

  private def flown(loop: LoopKind, link: LatencyProfile): Recording = served(points(Points())): path =>
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock    = Clock.ofNanos(VirtualTime.clock(system))
        val scenario = Surround(vehicles = 3)
        val settings = LoopSettings.every(Span.ofMillis(100)).copy(model = _ => ConstantVelocity)
        val planned  =
          PortFlight(
            loop.label,
            loop,
            scenario,
            Span.ofSeconds(12),
            ClockKind.Virtual,
            clock,
            settings,
            link.name
          )
        val recorder  = MemoryRecorder(planned.heading)
        val simulator = started(path, recorder, clock).fold(fail(_), identity)
        val vehicles  = simulator.vehicles.zipWithIndex.map((vehicle, number) =>
          if link == LatencyProfile.none then vehicle else LinkedVehicle(vehicle, link, 1, number, clock)
        )
        planned.start(vehicles, recorder, Some(simulator)).landed.map: landed =>
          assertEquals(landed.outcome, FlightOutcome.Completed)
          recorder.recording
      .value

  test(
    "a paused flight's rewards equal those of the environment's own loop under equal commands, to the digit"
  ):
    val recording = flown(LoopKind.Paused, LatencyProfile.none)
    val own       = Points()
    own.reset()
    val commands = names.map(name => recording.commands.filter(_.vehicle == name))
    val rewards  = (0 until 120).map: step =>
      own.step(commands.map(sent =>
        Vector3(sent(step).velocityNorth.value, sent(step).velocityEast.value, 0)
      ))
      own.rewards
    val recorded = names.map(name => recording.measurements.filter(_.vehicle == name).map(_.numbers.head))
    assertEquals(recorded.map(_.take(120)), rewards.toVector.transpose)
    assertEquals(recording.measurements.map(_.quantities).distinct, Vector(EnvironmentSimulator.Columns))

  for loop <- Seq(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive) do
    test(s"${loop.label} flies the environment in real time over the VPN, and every step is recorded"):
      val recording = flown(loop, LatencyProfile.vpn)
      val steps     = recording.measurements.filter(_.vehicle == "Evader")
      assertEquals(steps.map(_.sequence), Vector.tabulate(steps.size)(_ + 1L))
      assert(steps.size >= 115, steps.size)
      assert(recording.decisions.size > 80, recording.decisions.size)
      val ages =
        recording.readings.map(reading => reading.state.receivedAt.since(reading.state.sentAt).toMillis)
      assert(ages.sum / ages.size > 60, "over a VPN")

  test("the environment's time begins at the first reading, and stops while it is paused"):
    val recorded = served(points(Points())): path =>
      VirtualTime
        .run(seed = 1): system =>
          given ActorSystem = system
          import system.dispatcher
          val clock    = Clock.ofNanos(VirtualTime.clock(system))
          val recorder = recorderOf(clock)
          val world    = started(path, recorder, clock).fold(fail(_), identity)
          def pass     = after(Span.ofMillis(350).toDuration)(Future.unit)
          def steps    = recorder.recording.measurements.map(_.sequence).maxOption.getOrElse(0L)
          def told     =
            world.vehicles.head.read().map(read => (read.toOption.get.validAt.toNanos / 100_000_000, steps))
          for
            _     <- pass
            first <- told
            _     <- pass
            ran   <- told
            _     <- world.pause()
            _     <- pass
            stood <- told
            _     <- world.continueFor(Span.ofMillis(200))
            two   <- told
            _     <- world.resume()
            _     <- pass
            again <- told
          yield Vector(first, ran, stood, two, again)
        .value
    assertEquals(recorded, Vector(0L, 3L, 3L, 5L, 8L).map(step => (step, step)))

  test("an environment slower than the clock falls behind, says so now and then, and still answers"):
    // Every step takes 1.2 times as long as it simulates. More than 500 steps would be an endless call.
    val now                                      = AtomicLong()
    val world                                    = Points()
    var steps                                    = 0
    def slow(asked: ujson.Value): Option[String] =
      steps += 1
      now.addAndGet(120_000_000L)
      if steps > 500 then None else points(world)(asked)
    val (reads, events) = served(slow): path =>
      VirtualTime
        .run(seed = 1): system =>
          given ActorSystem = system
          import system.dispatcher
          val clock    = Clock.ofNanos(() => now.get)
          val recorder = recorderOf(clock)
          val vehicle  = started(path, recorder, clock).fold(fail(_), identity).vehicles.head
          val reads    = (0 until 100).foldLeft(Future.successful(Vector.empty[Long])): (before, _) =>
            for
              reads <- before
              read  <- vehicle.read()
              _ = now.addAndGet(100_000_000L)
            yield reads :+ read.fold(error => fail(error.message), _.validAt.toNanos / 100_000_000)
          reads.map(reads => (reads, recorder.recording.events))
        .value
    assertEquals(reads, (0L until 100L).toVector)
    assertEquals(events.map(_.kind).distinct, Vector(EventKind.ClockDrift))
    // 99 steps, each with 0.22 s of the clock's time; an event every 5 s of it, at most.
    assertEquals(events.size, 5)
    assert(events.last.detail.endsWith("it is 11.16 s behind the clock"), events.last.detail)

  test("a request that is longer than a socket's buffer arrives whole"):
    val many  = Vector.tabulate(20_000)(number => s"Vehicle$number")
    val heard = served(asked => Some(s"""{"error": "heard of ${asked("velocities").obj.size}"}""")): path =>
      EnvironmentProcess.connect(path, many).flatMap(_.step(many.map(_ => Vector3(1, 2, 3))))
    assertEquals(heard.left.toOption, Some("heard of 20000"))

  test("unsupported actions, errors and the end are reported"):
    def refused(answer: ujson.Value => Option[String]) = served(answer): path =>
      EnvironmentProcess.connect(path, names).flatMap(process => process.reset().left.map(identity))
    assertEquals(
      refused(_ => Some("""{"error": "ValueError: no\u001b[31m luck"}""")).left.toOption,
      Some("ValueError: no [31m luck")
    )
    assert(refused(_ => Some("[]")).left.exists(_.startsWith("expected an environment's answer, got")))
    assert(refused(_ => Some("""{"stepS": 0.1, "vehicles": {"Evader": {"body": [1, 2]}}}""")).left.exists(
      _.contains("[1,2] of Evader")
    ))
    assertEquals(refused(_ => None).left.toOption, Some("its process has ended"))
    assert(EnvironmentProcess.connect(
      "/nowhere",
      names
    ).left.exists(_.startsWith("expected an environment behind the socket /nowhere")))

    val world                                     = Points()
    var answers                                   = 0
    def three(asked: ujson.Value): Option[String] =
      answers += 1
      if answers > 3 then None else points(world)(asked)
    val (short, wrong, lost) = served(three): path =>
      VirtualTime
        .run(seed = 1): system =>
          given ActorSystem = system
          import system.dispatcher
          val clock     = Clock.ofNanos(VirtualTime.clock(system))
          val recorder  = recorderOf(clock)
          val simulator = started(path, recorder, clock).fold(fail(_), identity)
          for
            _     <- simulator.pause()
            short <- simulator.continueFor(Span.ofMillis(50))
            wrong <- simulator.vehicles.head.act(Action.Land, Span.ofSeconds(1))
            _     <- simulator.continueFor(Span.ofSeconds(1))
            lost  <- simulator.vehicles.head.read()
          yield (short, wrong, lost)
        .value
    assert(short.left.exists(_.message.contains("a multiple of 100.0 ms")), short)
    assert(wrong.left.exists(_.isInstanceOf[VehicleError.Unsupported]), wrong)
    assert(lost.left.exists(_.message == "the environment: its process has ended"), lost)
