package skein.margin

import java.util.concurrent.Executors
import org.apache.pekko.actor.ActorSystem
import scala.collection.mutable.ArrayBuffer
import scala.concurrent.duration.Duration
import scala.concurrent.{Await, ExecutionContext, Future}
import skein.airsim.{AirSimClient, Multirotor, WorldSettings}
import skein.flight.{Lateness, Preparation}
import skein.link.*
import skein.observe.{AirSimAnalysis, CallKind, Observed, ObservingProxy, OutsideProgram}
import skein.rpc.RpcClient
import skein.scenario.{Scenario, Track, Tracks}
import skein.scene.Scene
import skein.signal.LatencyProfile
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.units.*

/** A program and how it is judged.
  *
  * @param command `{port}` in its words stands for the simulator's port
  * @param scenario the scenario whose vehicles hover at their starts when the program begins
  * @param lasts maximum duration of a run; a program that still runs is stopped then
  * @param skip time after the first command that is not scored
  */
final case class MarginTask(
    command: Seq[String],
    world: WorldSettings,
    scene: Scene,
    scenario: Option[Scenario],
    judge: MarginJudge,
    lasts: Span,
    skip: Span
)

/** Runs a program against a simulator of its own, in real time. */
final class MarginTrial(task: MarginTask, clock: Clock)(using ActorSystem):
  import task.*
  import MarginTrial.*
  private given ExecutionContext = ExecutionContext.parasitic

  /** Executes a run. Blocks.
    *
    * @param isStopped whether the run must end early
    * @return Left says why the program cannot be run
    */
  def run(link: LatencyProfile, seed: Long, isStopped: () => Boolean): Either[String, MarginRuns.Outcome] =
    simulated(SimulatorSettings(world, AnyPort, scene = scene)): (server, transport, observer) =>
      for
        _   <- scenario.fold(Right(()))(place(_, server.address, transport))
        run <- flown(server, observer(EmulatedLink(LinkProfile.symmetric(link), seed, clock)), isStopped)
      yield run

  /** Calls the simulator through an observer for a while, so that their code is compiled before a run counts,
    * and then gives the control threads precedence, if the system allows it. Blocks.
    */
  def warmUp(): Unit =
    simulated(SimulatorSettings(address = AnyPort)): (_, transport, observer) =>
      val proxy  = observer(EmulatedLink(LinkProfile.none, 0, clock))
      val client = AirSimClient(RpcClient(transport, proxy.address, clock))
      val until  = clock.now() + Warming
      awaited(Multirotor.named(client, WorldSettings.Default.vehicles.head.name)).foreach: vehicle =>
        while clock.now() < until do
          awaited(vehicle.status()): Unit
          vehicle.moveByVelocityZ(Vector3(1, 0, 0), Metres(-20), Span.ofSeconds(1)): Unit
      Seq(client.close(), proxy.close()).foreach(awaited(_): Unit)
    BackgroundThread.compilersGiveWay(): Unit
    ControlThreads.lead(): Unit

  /** Uses a simulator, with observers that the user starts before it and closes. */
  private def simulated[A](settings: SimulatorSettings)(
      use: (SimulatorServer, Transport, EmulatedLink => ObservingProxy[Observed]) => A
  ): A =
    val transport = TcpTransport()
    val server    = awaited(SimulatorServer.start(settings, transport, clock))
    val reader    = Executors.newSingleThreadExecutor(Thread.ofPlatform().daemon().factory())
    try
      use(
        server,
        transport,
        link =>
          awaited(ObservingProxy.start(
            AirSimAnalysis(),
            AnyPort,
            server.address,
            link,
            transport,
            clock,
            reader
          ))
      )
    finally
      awaited(server.close()): Unit
      reader.shutdown()

  private def flown(server: SimulatorServer, proxy: ObservingProxy[Observed], isStopped: () => Boolean) =
    val port    = proxy.address.port.toString
    val watched =
      try
        for program <- OutsideProgram.start(command.map(_.replace(Port, port)), Map("SKEIN_PORT" -> port))
        yield
          val watch = Watch(server, proxy, program, isStopped)
          try watch.untilEnd()
          finally program.stop()
          watch.stopped()
          (watch, program)
      finally awaited(proxy.close()): Unit
    watched.map: (watch, program) =>
      MarginRuns.Outcome(watch.judged(proxy.observed), program.printed, watch.isCut)

  private def place(scenario: Scenario, at: Address, transport: Transport): Either[String, Unit] =
    val client = AirSimClient(RpcClient(transport, at, clock))
    try awaited(Preparation(client, clock).place(scenario.fleet)).map(_ => ())
    finally awaited(client.close()): Unit

  /** Watches one run: the vehicles' true positions, and the load of the machine. */
  private final class Watch(
      server: SimulatorServer,
      proxy: ObservingProxy[Observed],
      program: OutsideProgram,
      isStopped: () => Boolean
  ):
    private val startedAt = clock.now()
    private val truths    = ArrayBuffer.empty[SimulatorServer.Truth]
    private var lateness  = Lateness()
    private var begun     = Option.empty[Instant]
    private var course    = MarginCourse(startedAt)
    private var exit      = Option.empty[Int]

    var isCut = false

    /** Notes whether the program was ended early: by us, or by Ctrl-C, perhaps before that is known here. */
    def stopped(): Unit = isCut = !isOver && isStopped()

    private def isOver = course.lasted >= task.lasts

    def untilEnd(): Unit =
      var ticks = 0L
      while exit.isEmpty && !isOver && !isStopped() do
        val due = startedAt + Every * ticks
        program.await(due.since(clock.now()))
        val now = clock.now()
        lateness = lateness.ticked(now.since(due).max(Span.Zero))
        look(now)
        ticks += 1

    private def look(now: Instant): Unit =
      exit = program.exit
      val progress = proxy.progress
      course = course.looked(now, progress.lasted)
      if progress.commands > 0 then
        val truth = awaited(Future.firstCompletedOf(Seq(server.truth(), server.failed.map(throw _))))
        if begun.isEmpty then begun = Some(truth.at + skip)
        if begun.exists(truth.at >= _) then truths += truth

    def judged(observed: Observed): MarginRun =
      val ended = MarginRun.Ended(
        exit,
        course.lasted,
        observed.connections,
        observed.commands,
        course.silentFor,
        program.lastLine,
        program.lastError,
        contacts,
        tracks,
        lateness.starved.orElse(Lateness.skipped(server.behind))
      )
      val states = observed.methods.filter(_.kind == CallKind.State).flatMap(_.roundTripMs)
      MarginRun(
        MarginRun.judged(judge, ended),
        MarginRun.violations(scenario.fold(Vector.empty)(_.limits), ended),
        states.maxByOption(_.count).map(_.median),
        observed.vehicles.flatMap(_.ownAgeMs).map(_.mean).maxOption
      )

    private def contacts: Long =
      val counts = truths.map(_.vehicles.map(_.contacts).sum)
      counts.lastOption.zip(counts.headOption).fold(0L)(_ - _)

    private def tracks: Option[Tracks] =
      Option.when(truths.nonEmpty)(truths.head.vehicles.indices.toVector).flatMap: vehicles =>
        Tracks.of(vehicles.map: vehicle =>
          val role = scenario.fold("")(_.agents(vehicle).role.toString)
          Track.of(
            truths.head.vehicles(vehicle).name,
            role,
            truths.toVector.map: truth =>
              val at = truth.vehicles(vehicle).kinematics
              (truth.at, at.positionNed, at.velocityNed)
          ))

object MarginTrial:
  val Port = "{port}"

  private val AnyPort = Address("127.0.0.1", 0)

  private val Warming = Span.ofSeconds(3)

  /** Interval between two readings of the vehicles: the step of [[skein.scenario.Tracks]]. */
  private val Every = Span.ofMillis(20)

  private def awaited[A](future: Future[A]): A = Await.result(future, Duration.Inf)
